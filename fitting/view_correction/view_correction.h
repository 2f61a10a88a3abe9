// What calibration and rectification left wrong in the views, found from the photographs alone:
// where each flash was, what the surroundings add, and by how much each picture is displaced on the
// sample. A bundle adjustment of radiances: over a lattice of texels, their reflectance and the
// views' corrections are solved for together,
//
//   min Σ_texels Σ_views ρ( log(R(texel; light, ambient) + 0.01) − log(I(x + shift(x)) + 0.01) )
//       + (texel − its start)²/σ² + corrections²/σ²
//
// with R clamped to 1 for LDR photographs: eq. 2 of Gao et al. 2019 with a loss quadratic near 0.
// Texels are eliminated (Schur complement), as points are in a bundle adjustment. Solved on one
// thread, so that the result has one value.
//
// Lights that are wrong alike (a flash elsewhere beside the lens) and normals that are tilted alike
// explain matte photographs equally well. So what all lights share has a weak hold of its own, the
// texels' hold leaves a common tilt free, and the sample is expected to be flat in the mean.
#pragma once

#include <string>
#include <vector>

#include "fitting/photographs/photographs.h"
#include "fitting/photographs/picture_shift.h"
#include "fitting/reflectance/svbrdf_maps.h"

namespace glint {

// Added to what the view says. Nothing to correct: the default.
struct ViewCorrection {
  Vec3d light_offset_mm{0, 0, 0};
  Vec3d ambient_rgb{0, 0, 0};  // irradiance; the same for all views of a set
  double exposure = 1;         // factor
  CornerShifts shifts;         // the picture is to be looked up so far off, in texels
};

struct ViewCorrectionOptions {
  bool light = true;
  bool ambient = true;
  bool exposure = false;
  bool registration = true;
  double light_sigma = 0.03;  // standard deviation expected of the light's offset, of its distance
  // … beside what all lights share: the flash stands elsewhere beside the lens of an upright
  // camera.
  double shared_light_sigma = 0.3;
  double distance_sigma = 0.03;  // of its component toward the sample, likewise
  double level_sigma = 0.01;     // of the sample's mean slope
  double ambient_sigma = 0.1;    // of the ambient irradiance, of the flash's at the sample's centre
  double exposure_sigma = 0.1;   // of its logarithm
  double registration_sigma_texel = 1.0;
  double residual_sigma = 0.02;  // of log residuals
  double robust_scale = 0.1;     // log residuals beyond it count linearly
  // A view's residuals count together as so many against these expectations: they share the errors
  // of model and maps, and many small ones would otherwise buy any correction.
  double evidence = 20;
  int texels = 1024;    // of the lattice, about
  int iterations = 60;  // Levenberg–Marquardt steps, at most

  // Empty: all is well; otherwise what is wrong.
  std::string Check() const;
};

struct ViewCorrectionResult {
  std::vector<ViewCorrection> views;  // one per photograph
  double cost_before = 0, cost_after = 0;
  double residual_rms =
      0;  // afterwards, in units of the residuals' deviation, expectations included
  int iterations = 0;
  bool converged = false;
};

// `maps`: what the texels start from and are held to, weakly; of the set's size. Displacements are
// relative to their mean over the views: what all share is the maps' own place.
// Throws std::invalid_argument when sizes or options are wrong.
ViewCorrectionResult CorrectViews(const PhotographSet& set, const SvbrdfMaps& maps,
                                  const ViewCorrectionOptions& options);

// The photographs as the corrections say: lights moved, ambient added, pictures looked up anew.
PhotographSet Corrected(const PhotographSet& set, const std::vector<ViewCorrection>& corrections,
                        int threads);

// The same corrections for pictures of another size.
std::vector<ViewCorrection> AtSize(std::vector<ViewCorrection> corrections, int from_width,
                                   int from_height, int to_width, int to_height);

// Angle at the sample's centre between where the light was said to be and where it is found.
double LightTurnedDeg(const View& view, const ViewCorrection& correction);

}  // namespace glint
