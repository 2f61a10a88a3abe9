#include "calib/light/power.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/statistics/median.h"

namespace glint {
namespace {

constexpr size_t kLeastSamples = 4;  // a photo with fewer has no say

// cosθ/d² at a spot; 0 on the light's far side.
double Irradiance(const Eigen::Vector2d& spot, const Eigen::Vector3d& light_in_sample_mm) {
  const Eigen::Vector3d way = light_in_sample_mm - Eigen::Vector3d(spot.x(), spot.y(), 0);
  const double d2 = way.squaredNorm();
  return way.z() > 0 ? way.z() / (std::sqrt(d2) * d2) : 0;
}

}  // namespace

PowerEstimate EstimatePower(const std::vector<LitPaper>& photos, const PowerOptions& options) {
  PowerEstimate estimate;
  std::vector<double> by_photo[3];
  for (const LitPaper& photo : photos) {
    const Eigen::Vector3d light = Inverse(photo.camera_from_sample) * photo.light_in_camera_mm;
    std::vector<double> by_spot[3];
    for (const PaperSample& sample : photo.samples) {
      const double irradiance = Irradiance(sample.position_in_sample_mm, light);
      if (irradiance <= 0) continue;
      for (int c = 0; c < 3; ++c) {
        const double total =
            sample.radiance[c] * std::numbers::pi / (options.paper_reflectance * photo.exposure);
        by_spot[c].push_back((total - options.ambient[c]) / irradiance);
      }
    }
    const bool enough = by_spot[0].size() >= kLeastSamples;
    estimate.photo_power.push_back(0);
    if (!enough) continue;
    estimate.samples += static_cast<int>(by_spot[0].size());
    for (int c = 0; c < 3; ++c) {
      by_photo[c].push_back(Median(by_spot[c]));
      estimate.photo_power.back() += by_photo[c].back() / 3;
    }
  }
  if (by_photo[0].empty()) return estimate;
  for (int c = 0; c < 3; ++c) estimate.light_rgb[c] = Median(by_photo[c]);
  estimate.known = estimate.light_rgb.minCoeff() > 0;
  std::vector<double> used, deviations;
  std::copy_if(estimate.photo_power.begin(), estimate.photo_power.end(), std::back_inserter(used),
               [](double power) { return power > 0; });
  const double middle = Median(used);
  for (const double power : used) deviations.push_back(std::abs(power - middle));
  if (middle > 0) estimate.spread = 1.4826 * Median(deviations) / middle;
  return estimate;
}

}  // namespace glint
