// Quantiles of a sample.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace glint {

// Value below which the given share of the sample lies, interpolated. 0 for an empty sample.
inline double Quantile(std::vector<double> sample, double share) {
  if (sample.empty()) return 0;
  const double place = share * static_cast<double>(sample.size() - 1);
  const auto low = sample.begin() + static_cast<ptrdiff_t>(place);
  std::nth_element(sample.begin(), low, sample.end());
  const double high = low + 1 < sample.end() ? *std::min_element(low + 1, sample.end()) : *low;
  return *low + (place - std::floor(place)) * (high - *low);
}

}  // namespace glint
