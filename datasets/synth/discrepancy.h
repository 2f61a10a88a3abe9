// Photographs of what the reflectance model cannot express, from maps whose truth is known: how
// fitting copes with model discrepancy (Kennedy and O'Hagan 2001), measured where real samples have
// no truth. Everything scales with one strength: 0 is nothing, 1 is about what real samples and
// calibrated phone captures show (docs/evaluation.md).
#pragma once

#include <cstdint>
#include <vector>

#include "base/reflectance/svbrdf_maps.h"
#include "base/reflectance/view.h"
#include "fitting/relief/height_field.h"

namespace glint {

enum class DiscrepantLobe { kSecondLobe, kAnisotropic };

// What a set's photographs are made with, at strength 1.
struct Discrepancy {
  double strength = 0;

  // The specular lobe is not one isotropic GGX lobe: by the set's seed either a second one …
  double second_lobe_share = 0.35;  // of the specular radiance …
  double second_lobe_width = 2.2;   // … as many times as rough
  // … or normals scatter within a texel along one direction: as so many times α.
  double anisotropy = 1.0;
  // The relief whose normals the maps hold: parallax, and cast shadows.
  bool relief = true;
  // Light that leaves a sample beside where it entered: standard deviation, mm, of diffuse
  // radiance.
  double diffuse_blur_mm = 0.3;
  // What a capture does not know of itself, standard deviations (see Disturbance for the others).
  double exposure = 0.05;
  double light_off_deg = 2;
  double registration_texel = 0.5;
  double ambient_percent = 2;
  int jpeg_quality = 92;

  bool any() const { return strength > 0; }
};

// The set's own draws.
struct DrawnDiscrepancy {
  DiscrepantLobe lobe = DiscrepantLobe::kSecondLobe;
  double azimuth_rad = 0;         // along which normals scatter
  std::vector<double> exposures;  // factors, by view
};
DrawnDiscrepancy DrawDiscrepancy(const Discrepancy& discrepancy, std::uint64_t seed, int views);

// Radiance [3·H·W] of the maps in one view as such a sample shows it. `relief`: IntegrateNormals of
// the maps, of the plane's size.
std::vector<float> RenderDiscrepant(const Discrepancy& discrepancy, const DrawnDiscrepancy& drawn,
                                    const SvbrdfMaps& maps, const HeightField& relief,
                                    const SamplePlane& plane, const View& view,
                                    const ReflectanceConvention& convention, int threads);

// 8-bit codes [3·H·W, interleaved] after compression.
std::vector<unsigned char> JpegRoundTrip(const std::vector<unsigned char>& codes, int width,
                                         int height, int quality);

}  // namespace glint
