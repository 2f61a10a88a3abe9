// What tests of procedural materials measure.
#pragma once

#include <cmath>
#include <span>

#include "base/reflectance/svbrdf_maps.h"

namespace glint {

inline double Mean(std::span<const float> plane) {
  double sum = 0;
  for (const float v : plane) sum += v;
  return sum / static_cast<double>(plane.size());
}

// Standard deviation.
inline double Spread(std::span<const float> plane) {
  const double mean = Mean(plane);
  double square = 0;
  for (const float v : plane) square += (v - mean) * (v - mean);
  return std::sqrt(square / static_cast<double>(plane.size()));
}

inline double MeanDifference(const SvbrdfMaps& a, const SvbrdfMaps& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.planes.size(); ++i) sum += std::fabs(a.planes[i] - b.planes[i]);
  return sum / static_cast<double>(a.planes.size());
}

// Each texel the mean of four.
inline SvbrdfMaps Halved(const SvbrdfMaps& fine) {
  SvbrdfMaps out(fine.width / 2, fine.height / 2);
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    for (int row = 0; row < out.height; ++row) {
      for (int column = 0; column < out.width; ++column) {
        out.at(p, row, column) =
            0.25f * (fine.at(p, 2 * row, 2 * column) + fine.at(p, 2 * row, 2 * column + 1) +
                     fine.at(p, 2 * row + 1, 2 * column) + fine.at(p, 2 * row + 1, 2 * column + 1));
      }
    }
  }
  return out;
}

}  // namespace glint
