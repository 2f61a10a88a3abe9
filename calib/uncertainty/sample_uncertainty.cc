#include "calib/uncertainty/sample_uncertainty.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "calib/uncertainty/projection_jacobian.h"

namespace glint {

std::optional<Eigen::Matrix2d> PlaceCovariance(const BundleResult& result, size_t photo,
                                               const Eigen::Vector2d& position_in_sample_mm) {
  const PhotoEstimate& estimate = result.photos[photo];
  const CameraEstimate& camera = result.cameras[estimate.camera];
  if (estimate.covariance_with_camera.cols() == 0) return std::nullopt;  // undetermined
  const Eigen::Vector3d at(position_in_sample_mm.x(), position_in_sample_mm.y(), 0);
  const Eigen::Vector3d in_camera = estimate.camera_from_sample * at;
  if (!(in_camera.z() > 1e-9)) return std::nullopt;
  const ProjectionJacobian j = Differentiate(camera.camera, in_camera);
  // The pose's covariance is of (w, δt) beside its rotation: the point moves by w × (R·X) + δt.
  const Eigen::Matrix<double, 2, 6> by_pose =
      ByMotion(j.by_point, in_camera - estimate.camera_from_sample.translation);
  const Eigen::Matrix2d mixed =
      by_pose * estimate.covariance_with_camera * j.by_parameters.transpose();
  const Eigen::Matrix2d image = j.by_parameters * camera.covariance * j.by_parameters.transpose() +
                                by_pose * estimate.covariance * by_pose.transpose() + mixed +
                                mixed.transpose();
  const Eigen::Matrix2d by_place = j.by_point * estimate.camera_from_sample.rotation.leftCols<2>();
  if (!(std::abs(by_place.determinant()) > 1e-12)) return std::nullopt;
  const Eigen::Matrix2d back = by_place.inverse();
  return Eigen::Matrix2d(back * image * back.transpose());
}

SampleUncertainty UncertaintyAtSample(const BundleResult& result, size_t photo,
                                      const Eigen::Vector2d& sample_size_mm) {
  constexpr int kSide = 5;
  SampleUncertainty out;
  double variance = 0;
  int places = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Eigen::Vector2d share(i % kSide / (kSide - 1.0) - 0.5, i / kSide / (kSide - 1.0) - 0.5);
    const auto covariance = PlaceCovariance(result, photo, share.cwiseProduct(sample_size_mm));
    if (!covariance) continue;
    variance += 0.5 * covariance->trace();
    out.largest_mm = std::max(out.largest_mm, WorstSigma(*covariance));
    ++places;
  }
  if (places > 0) out.sigma_mm = std::sqrt(variance / places);
  return out;
}

}  // namespace glint
