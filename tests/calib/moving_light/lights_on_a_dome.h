// Directions of lights that are spread over the half sphere.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <vector>

namespace glint::testing {

// On a spiral from `high_deg` down to `low_deg` above the sample's plane.
inline std::vector<Eigen::Vector3d> LightsOnADome(int count, double low_deg = 15,
                                                  double high_deg = 80) {
  constexpr double kRadian = std::numbers::pi / 180, kGoldenAngle = 2.399963229728653;
  const double low = std::sin(low_deg * kRadian), high = std::sin(high_deg * kRadian);
  std::vector<Eigen::Vector3d> lights;
  for (int i = 0; i < count; ++i) {
    const double z = high + (low - high) * (i + 0.5) / count, side = std::sqrt(1 - z * z);
    lights.emplace_back(side * std::cos(kGoldenAngle * i), side * std::sin(kGoldenAngle * i), z);
  }
  return lights;
}

}  // namespace glint::testing
