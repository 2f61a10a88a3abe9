#include "fitting/refine/odd_views.h"

#include <cmath>

#include "base/statistics/median.h"

namespace glint {

std::vector<size_t> OddViews(const std::vector<double>& losses) {
  constexpr double kMostTimesMedian = 2;
  constexpr size_t kFewestViews = 4;
  std::vector<double> known;
  for (const double loss : losses) {
    if (std::isfinite(loss)) known.push_back(loss);
  }
  std::vector<size_t> odd;
  if (known.size() < kFewestViews) return odd;
  const double most = kMostTimesMedian * Median(known);
  for (size_t i = 0; i < losses.size(); ++i) {
    if (std::isfinite(losses[i]) && losses[i] > most) odd.push_back(i);
  }
  return odd;
}

}  // namespace glint
