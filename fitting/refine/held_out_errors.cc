#include "fitting/refine/held_out_errors.h"

#include <algorithm>
#include <cmath>

#include "base/model/solver.h"

namespace glint {
namespace {

double Squared(double x) { return x * x; }

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
  folds_.back().sum += squares;
  folds_.back().by_place[place] += squares;
}

double HeldOutErrors::SumOf(size_t folds) const {
  double sum = 0;
  for (size_t f = 0; f < folds; ++f) sum += folds_[f].sum;
  return sum;
}

std::vector<double> HeldOutErrors::ByPlace(size_t folds) const {
  std::vector<double> sums(places_, 0.0);
  for (size_t f = 0; f < folds; ++f) {
    for (size_t place = 0; place < places_; ++place) sums[place] += folds_[f].by_place[place];
  }
  return sums;
}

double HeldOutErrors::EnergyAgainst(const HeldOutErrors& other) const {
  const size_t both = std::min(folds(), other.folds());
  const double here = SumOf(both), there = other.SumOf(both);
  // Nothing is seen of the views held out.
  if (!(here > 0) || !(there > 0)) return 0;
  const double logarithm = std::log(here / there);
  if (logarithm == 0) return 0;
  double variance = 0;
  for (size_t f = 0; f < both; ++f) {
    variance += Squared(folds_[f].sum / here - other.folds_[f].sum / there);
  }
  const std::vector<double> by_place = ByPlace(both), others = other.ByPlace(both);
  for (size_t place = 0; place < places_; ++place) {
    variance += Squared(by_place[place] / here - others[place] / there);
  }
  return std::copysign(2 * logarithm * logarithm / variance, logarithm);
}

}  // namespace glint
