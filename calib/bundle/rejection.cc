#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/statistics/median.h"
#include "calib/bundle/bundle_internal.h"

namespace glint::bundle {
namespace {

std::vector<double> Lengths(const std::vector<Eigen::Vector2d>& residuals) {
  std::vector<double> lengths;
  for (const Eigen::Vector2d& r : residuals) lengths.push_back(r.norm());
  return lengths;
}

}  // namespace

std::vector<Eigen::Vector2d> Residuals(const BundlePhoto& photo, const State& state,
                                       const PhotoState& photo_state) {
  const Camera& camera = state.cameras[photo.camera];
  const Rigid3 camera_from_sample = photo_state.camera_from_sample();
  std::vector<Eigen::Vector2d> residuals;
  for (const BundleCorner& corner : photo.corners) {
    const Eigen::Vector2d& at = corner.position_in_sample_mm;
    const Eigen::Vector3d p =
        camera_from_sample * Eigen::Vector3d(at.x(), at.y(), state.bend.HeightAt(at));
    if (p.z() > 1e-9) {
      residuals.push_back(corner.point_px - ImageFromCamera(camera, p));
    } else {
      residuals.emplace_back(1e6, 1e6);
    }
  }
  return residuals;
}

double RobustSigma(const BundleProblem& problem, const State& state) {
  std::vector<double> lengths;
  for (size_t i = 0; i < problem.photos.size(); ++i) {
    if (!state.photos[i].accepted) continue;
    const auto residuals = Residuals(problem.photos[i], state, state.photos[i]);
    for (size_t k = 0; k < residuals.size(); ++k) {
      if (state.photos[i].inlier[k]) lengths.push_back(residuals[k].norm());
    }
  }
  return Median(lengths) / 1.1774;  // the median of Rayleigh's distribution
}

bool Reject(const BundleProblem& problem, const BundleOptions& options, double sigma_px,
            State* state) {
  const double limit_px = std::max(options.reject_sigmas * sigma_px, options.min_reject_px);
  std::vector<double> medians(problem.photos.size(), 0);
  std::vector<double> usual;
  bool changed = false;
  for (size_t i = 0; i < problem.photos.size(); ++i) {
    PhotoState& photo = state->photos[i];
    if (!photo.accepted) continue;
    const auto lengths = Lengths(Residuals(problem.photos[i], *state, photo));
    medians[i] = Median(lengths);
    usual.push_back(medians[i]);
    for (size_t k = 0; k < lengths.size(); ++k) {
      const bool inlier = lengths[k] <= limit_px;
      changed = changed || inlier != photo.inlier[k];
      photo.inlier[k] = inlier;
    }
  }
  const double photo_limit_px =
      std::max(options.max_photo_ratio * Median(usual), options.min_reject_px);
  for (size_t i = 0; i < problem.photos.size(); ++i) {
    PhotoState& photo = state->photos[i];
    if (!photo.accepted) continue;
    const auto inliers = std::count(photo.inlier.begin(), photo.inlier.end(), true);
    const auto corners = static_cast<long>(photo.inlier.size());
    if (medians[i] > photo_limit_px || inliers < options.min_corners ||
        static_cast<double>(inliers) < options.min_inlier_share * static_cast<double>(corners)) {
      photo.accepted = false;
      photo.rejected = fmt::format(
          "inconsistent with the others: {} of its {} corners within {:.2f} px, median residual "
          "{:.2f} px (usual: {:.2f} px)",
          inliers, corners, limit_px, medians[i], Median(usual));
      changed = true;
    }
  }
  return changed;
}

}  // namespace glint::bundle
