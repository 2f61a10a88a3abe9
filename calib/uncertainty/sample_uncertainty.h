// How well a photograph's texels are placed on the sample.
//
// Rectification looks a texel X of the sample's plane up at q = π(k, camera_from_sample · X). With
// the joint covariance of the intrinsics k and the pose,
//   Σ_q = J Σ Jᵀ,  J = [∂q/∂k, ∂q/∂pose],   and on the sample  Σ_X = (∂q/∂X)⁻¹ Σ_q (∂q/∂X)⁻ᵀ.
// The sample's frame is the board's, so that no motion of the camera's frame has to be taken out.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "calib/bundle/bundle.h"

namespace glint {

struct SampleUncertainty {
  double sigma_mm = 0;    // of one coordinate: root of the mean variance over the sample
  double largest_mm = 0;  // in the worst direction at the worst place
};

// Covariance (mm²) of the place on the sample's plane that a photo's pixel is attributed to;
// nullopt where the camera does not see the place, or the photo's pose is not determined.
std::optional<Eigen::Matrix2d> PlaceCovariance(const BundleResult& result, size_t photo,
                                               const Eigen::Vector2d& position_in_sample_mm);

// Over a sample of this size round the origin. Zeros where the photo does not see it.
SampleUncertainty UncertaintyAtSample(const BundleResult& result, size_t photo,
                                      const Eigen::Vector2d& sample_size_mm);

}  // namespace glint
