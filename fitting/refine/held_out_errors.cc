#include "fitting/refine/held_out_errors.h"

#include <cmath>
#include <numeric>

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

}  // namespace

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
