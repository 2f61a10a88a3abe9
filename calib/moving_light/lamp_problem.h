// What photographs of a camera that stood still tell of its lamps.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace glint {

// Radiance that stray light and rounding to 8 bits leave uncertain: half a code at gamma 2.2.
inline constexpr double kDarkRadiance = 0.002;
// A Gaussian's standard deviation by its median absolute deviation.
inline constexpr double kSdOfMedian = 1.4826;

// Radiance at points of the sample in every photograph.
struct LampProblem {
  std::vector<Eigen::Vector3d> points_mm;  // on the sample
  std::vector<Eigen::Vector3d> lights_mm;  // by photograph, in the sample's frame
  // By photograph, then point: linear R, G, B; a channel below 0: clipped, or not seen.
  std::vector<std::vector<std::array<float, 3>>> radiance;
};

}  // namespace glint
