#include "calib/guidance/expected_error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace glint {
namespace {

struct Row {
  double photos, maps, render;
};
// ExpectedError.IsThatOfTheTable compares it with docs/results/table1.md.
constexpr std::array<Row, 4> kTable{{{1, 0.009383, 0.003720},
                                     {2, 0.006585, 0.002064},
                                     {5, 0.002949, 0.000105},
                                     {20, 0.001165, 0.0000123}}};

double Between(double low, double high, double part) {
  return std::exp(std::log(low) + part * (std::log(high) - std::log(low)));
}

}  // namespace

ExpectedError ErrorForPhotos(double photos) {
  const double n = std::clamp(photos, kTable.front().photos, kTable.back().photos);
  size_t i = 0;
  while (i + 2 < kTable.size() && n > kTable[i + 1].photos) ++i;
  const Row &a = kTable[i], &b = kTable[i + 1];
  const double part = std::log(n / a.photos) / std::log(b.photos / a.photos);
  return {Between(a.maps, b.maps, part), Between(a.render, b.render, part)};
}

}  // namespace glint
