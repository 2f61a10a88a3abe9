#include "fitting/tiling/match_distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

constexpr int kQuantiles = 256;

std::vector<double> QuantilesOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::vector<double> quantiles;
  for (int q = 0; q <= kQuantiles; ++q) {
    const double at = static_cast<double>(values.size() - 1) * q / kQuantiles;
    const auto below = static_cast<size_t>(at);
    const auto above = std::min(below + 1, values.size() - 1);
    const double share = at - static_cast<double>(below);
    quantiles.push_back((1 - share) * values[below] + share * values[above]);
  }
  return quantiles;
}

// The place of `value` among increasing quantiles, 0 to kQuantiles; in the middle of those that
// are equal to it.
double PlaceOf(double value, const std::vector<double>& quantiles) {
  const auto [first, last] = std::equal_range(quantiles.begin(), quantiles.end(), value);
  if (first != last) {
    return 0.5 * static_cast<double>((first - quantiles.begin()) + (last - 1 - quantiles.begin()));
  }
  if (first == quantiles.begin()) return 0;
  if (first == quantiles.end()) return kQuantiles;
  const double below = *(first - 1), above = *first;
  return static_cast<double>(first - 1 - quantiles.begin()) + (value - below) / (above - below);
}

double ValueAt(double place, const std::vector<double>& quantiles) {
  const int below = std::min(static_cast<int>(place), kQuantiles - 1);
  const double share = place - below;
  return (1 - share) * quantiles[below] + share * quantiles[below + 1];
}

void MatchAlongLine(const std::vector<double>& wanted, std::vector<double>* values) {
  const std::vector<double> to = QuantilesOf(wanted), from = QuantilesOf(*values);
  for (double& value : *values) value = ValueAt(PlaceOf(value, from), to);
}

std::vector<double> Projected(std::span<const float> x, std::span<const float> y, double c,
                              double s) {
  std::vector<double> along(x.size());
  for (size_t i = 0; i < x.size(); ++i) along[i] = c * x[i] + s * y[i];
  return along;
}

void Rotate(double c, double s, PlaneValues* values) {
  for (size_t i = 0; i < values->x.size(); ++i) {
    const double x = values->x[i], y = values->y[i];
    values->x[i] = c * x + s * y;
    values->y[i] = c * y - s * x;
  }
}

}  // namespace

void MatchDistribution(std::span<const float> wanted, std::vector<double>* values) {
  MatchAlongLine({wanted.begin(), wanted.end()}, values);
}

void MatchDistribution(std::span<const float> wanted_x, std::span<const float> wanted_y,
                       PlaneValues* values) {
  // The last along the axes, so that each map has its distribution exactly.
  for (const double turn : {0.0, 0.125, 0.375, 0.25, 0.0}) {
    const double c = std::cos(turn * std::numbers::pi), s = std::sin(turn * std::numbers::pi);
    Rotate(c, s, values);
    MatchAlongLine(Projected(wanted_x, wanted_y, c, s), &values->x);
    MatchAlongLine(Projected(wanted_x, wanted_y, -s, c), &values->y);
    Rotate(c, -s, values);
  }
}

}  // namespace glint
