#include "fitting/refine/held_out_errors.h"

#include <cmath>
#include <numeric>

#include "base/model/solver.h"

namespace glint {
namespace {

double SquaredDifferences(const std::vector<double>& a, double sum_a, const std::vector<double>& b,
                          double sum_b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double difference = a[i] / sum_a - b[i] / sum_b;
    sum += difference * difference;
  }
  return sum;
}

// Charbonnier's root, of which g² = 2e²/(1 + root).
double RootOf(double difference, double robust_scale) {
  const double scaled = difference / robust_scale;
  return std::sqrt(1 + scaled * scaled);
}

// The logarithm that all differences of a view are less by at their least sum of squares: a mean by
// the weights that these squares give (iteratively reweighted least squares).
double CommonDifference(std::span<const ViewDifferences> texels, size_t view, double robust_scale) {
  double common = 0;
  for (int i = 0; i < constants::kExposureIterations; ++i) {
    double sum = 0, weights = 0;
    for (const ViewDifferences& texel : texels) {
      if (!texel[view]) continue;
      for (const float difference : *texel[view]) {
        const double weight = 1 / RootOf(difference - common, robust_scale);
        sum += weight * difference;
        weights += weight;
      }
    }
    if (weights > 0) common = sum / weights;
  }
  return common;
}

}  // namespace

std::vector<double> SquaresOf(std::span<const ViewDifferences> texels, double robust_scale,
                              bool free_exposures) {
  std::vector<double> squares(texels.size(), 0.0);
  const size_t views = texels.empty() ? 0 : texels.front().size();
  for (size_t view = 0; view < views; ++view) {
    const double common = free_exposures ? CommonDifference(texels, view, robust_scale) : 0;
    for (size_t k = 0; k < texels.size(); ++k) {
      if (!texels[k][view]) continue;
      for (const float difference : *texels[k][view]) {
        const double e = difference - common;
        squares[k] += 2 * e * e / (1 + RootOf(e, robust_scale));
      }
    }
  }
  return squares;
}

void HeldOutErrors::Add(size_t place, double squares) {
  by_fold_.back() += squares;
  by_place_[place] += squares;
}

double HeldOutErrors::sum() const { return std::accumulate(by_fold_.begin(), by_fold_.end(), 0.0); }

double HeldOutErrors::EnergyAgainst(const HeldOutErrors& other) const {
  const double here = sum(), there = other.sum();
  // Nothing is seen of the views held out.
  if (!(here > 0) || !(there > 0)) return 0;
  const double logarithm = std::log(here / there);
  if (logarithm == 0) return 0;
  const double variance = SquaredDifferences(by_fold_, here, other.by_fold_, there) +
                          SquaredDifferences(by_place_, here, other.by_place_, there);
  return std::copysign(2 * logarithm * logarithm / variance, logarithm);
}

}  // namespace glint
