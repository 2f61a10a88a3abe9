// One texel in one view: the residuals of its three channels, for Ceres.
#pragma once

#include <ceres/sized_cost_function.h>

#include "fitting/view_correction/view_correction.h"

namespace glint {

// A texel's parameters: diffuse 3, specular 3, roughness, slopes x and y (normal ∝ (x, y, 1)).
enum TexelParameter : int {
  kTexelDiffuse = 0,
  kTexelSpecular = 3,
  kTexelRough = 6,
  kTexelSlope = 7
};
inline constexpr int kTexelSize = 9;

// What all costs of a view share.
struct ViewContext {
  const Photograph* photograph = nullptr;
  SamplePlane plane;
  ReflectanceConvention convention;
  double light_distance_mm = 1;
  double irradiance = 1;  // of the flash at the sample's centre, unexposed, mean of the channels
  double weight = 1;      // of a residual
  double robust_scale = 0.1;
};

// Parameter blocks: texel (9), light offset by the light's distance (3), ambient irradiance by the
// flash's (3), logarithm of the exposure (1), displacement of the corners' columns and rows (8).
class RadianceCost : public ceres::SizedCostFunction<3, kTexelSize, 3, 3, 1, 8> {
 public:
  // `context` must outlive this.
  RadianceCost(const ViewContext& context, int column, int row);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const ViewContext& context_;
  const int column_, row_;
  double position_mm_[2];
  double camera_[3];  // unit, from the texel
  double corner_weights_[4];
};

}  // namespace glint
