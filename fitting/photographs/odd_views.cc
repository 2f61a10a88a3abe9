#include "fitting/photographs/odd_views.h"

#include <algorithm>
#include <cmath>

#include "base/statistics/median.h"

namespace glint {

std::vector<size_t> OddViews(const std::vector<double>& losses, double most) {
  constexpr size_t kFewestViews = 4;
  constexpr double kNoHarm = 0.05;
  std::vector<double> known;
  for (const double loss : losses) {
    if (std::isfinite(loss)) known.push_back(loss);
  }
  std::vector<size_t> odd;
  if (known.size() < kFewestViews) return odd;
  const double most_loss = std::max(most * Median(known), kNoHarm);
  for (size_t i = 0; i < losses.size(); ++i) {
    if (std::isfinite(losses[i]) && losses[i] > most_loss) odd.push_back(i);
  }
  return odd;
}

}  // namespace glint
