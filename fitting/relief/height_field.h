// The surface whose normals the maps hold.
#pragma once

#include <span>
#include <vector>

#include "base/reflectance/svbrdf_maps.h"
#include "base/reflectance/view.h"

namespace glint {

// Height above the sample's mean plane at the texels' centres, rows top (+y) to bottom.
struct HeightField {
  int width = 0, height = 0;
  double texel_x_mm = 0, texel_y_mm = 0;  // distance between neighbouring texels
  std::vector<float> height_mm;           // H·W, mean 0
  bool repeats = false;  // the texel right of the last column is that of the first, and so on

  float at(int row, int column) const {
    return height_mm[static_cast<size_t>(row) * width + column];
  }
  // Bilinear between texels' centres; border texels continue, or the field repeats.
  double Lookup(double row, double column) const;

 private:
  double LookupRepeating(double row, double column) const;
};

// The height whose differences between neighbouring texels are nearest, in least squares, to those
// that the normals say: Poisson's equation with free borders, solved exactly by cosine transforms
// (Frankot and Chellappa, "A method for enforcing integrability in shape from shading algorithms",
// PAMI 1988, with Neumann's boundary in place of a periodic one). Slopes are at most
// kMostReliefSlope.
//
// A small error that normals share adds up over long distances. With `longest_mm` above 0 the
// sample is expected to be flat on larger scales: waves of that length are halved, longer ones
// flattened, those of a third of it lose a tenth (a screened Poisson equation).
//
// `trust`: by texel, H·W, what its normal is worth against others', above 0 (TrustOfNormals());
// empty: all the same. The equation is then solved by conjugate gradients, preconditioned with the
// cosine transforms, to a thousandth of the first residual. Throws std::invalid_argument where
// there are not as many as texels. The same for any number of threads.
inline constexpr double kMostReliefSlope = 5;  // 79°: a normal beyond says little about height
HeightField IntegrateNormals(const SvbrdfMaps& maps, const SamplePlane& plane,
                             double longest_mm = 0, std::span<const float> trust = {},
                             int threads = 1);
// The same of maps that repeat (fitting/tiling): so do the heights.
HeightField IntegrateRepeatingNormals(const SvbrdfMaps& maps, const SamplePlane& plane,
                                      double longest_mm = 0);

// 1/(σ² + m²), relative to the median's: σ² is the mean of both standard deviations' squares and m²
// its median, for errors that stated deviations do not hold. H·W each.
std::vector<float> TrustOfNormals(std::span<const float> sigma_x, std::span<const float> sigma_y);

// Normals of a height field, by central differences: [3·H·W], planar.
std::vector<float> NormalsOf(const HeightField& field);

}  // namespace glint
