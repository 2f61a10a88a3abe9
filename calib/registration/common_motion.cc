#include "calib/registration/common_motion.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "base/model/solver.h"
#include "calib/registration/window_shifts.h"

namespace glint {
namespace {

CommonMotion Fit(const std::vector<ViewShift>& views, const std::vector<double>& weights,
                 double height_sd_mm) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  normal(2, 2) = 1 / (height_sd_mm * height_sd_mm);
  for (size_t i = 0; i < views.size(); ++i) {
    const double weight = weights[i] / (views[i].sd_mm * views[i].sd_mm);
    for (int axis = 0; axis < 2; ++axis) {
      Eigen::Vector3d row(axis == 0, axis == 1, views[i].per_height[axis]);
      normal += weight * row * row.transpose();
      right += weight * row * views[i].shift_mm[axis];
    }
  }
  const Eigen::Vector3d motion = normal.ldlt().solve(right);
  return {motion.head<2>(), motion[2]};
}

double SquaredSds(const ViewShift& view, const CommonMotion& motion) {
  return motion.Off_mm(view).squaredNorm() / (view.sd_mm * view.sd_mm);
}

CommonMotion Descend(const std::vector<ViewShift>& views, int first, int second,
                     double height_sd_mm) {
  std::vector<double> weights(views.size(), 0);
  weights[static_cast<size_t>(first)] = weights[static_cast<size_t>(second)] = 1;
  CommonMotion motion = Fit(views, weights, height_sd_mm);
  for (int step = 0; step < constants::kCommonMotionSteps; ++step) {
    for (size_t i = 0; i < views.size(); ++i) weights[i] = 1 / (1 + SquaredSds(views[i], motion));
    motion = Fit(views, weights, height_sd_mm);
  }
  return motion;
}

}  // namespace

CommonMotion FindCommonMotion(const std::vector<ViewShift>& views, double height_sd_mm) {
  if (views.size() == 1) return {views[0].shift_mm, 0};
  CommonMotion best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [first, second] : PairsOf(static_cast<int>(views.size()))) {
    const CommonMotion motion = Descend(views, first, second, height_sd_mm);
    double cost = 0.5 * std::pow(motion.height_mm / height_sd_mm, 2);
    for (const ViewShift& view : views) cost += std::log1p(SquaredSds(view, motion));
    if (cost >= least) continue;
    least = cost;
    best = motion;
  }
  return best;
}

}  // namespace glint
