#include "datasets/statistics/distance.h"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

// Calls step(value, gap, next) for every value of either sorted sample, with the gap of the
// cumulative distributions behind it and the value that ends it.
template <typename Step>
void WalkGaps(const std::vector<double>& a, const std::vector<double>& b, Step step) {
  size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const double value = j == b.size() || (i < a.size() && a[i] <= b[j]) ? a[i] : b[j];
    while (i < a.size() && a[i] == value) ++i;
    while (j < b.size() && b[j] == value) ++j;
    double next = value;
    if (i < a.size() || j < b.size()) {
      next = j == b.size() || (i < a.size() && a[i] <= b[j]) ? a[i] : b[j];
    }
    const double gap = static_cast<double>(i) / static_cast<double>(a.size()) -
                       static_cast<double>(j) / static_cast<double>(b.size());
    step(std::fabs(gap), next - value);
  }
}

}  // namespace

double KolmogorovSmirnov(std::vector<double> a, std::vector<double> b) {
  if (a.empty() || b.empty()) return a.empty() == b.empty() ? 0 : 1;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double largest = 0;
  WalkGaps(a, b, [&](double gap, double) { largest = std::max(largest, gap); });
  return largest;
}

double Wasserstein(std::vector<double> a, std::vector<double> b) {
  if (a.empty() || b.empty()) return 0;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double sum = 0;
  WalkGaps(a, b, [&](double gap, double length) { sum += gap * length; });
  return sum;
}

double HistogramKolmogorovSmirnov(std::span<const double> a, std::span<const double> b) {
  double gap = 0, largest = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    gap += a[i] - b[i];
    largest = std::max(largest, std::fabs(gap));
  }
  return largest;
}

double HistogramWasserstein(std::span<const double> a, std::span<const double> b, double width) {
  double gap = 0, sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    gap += a[i] - b[i];
    sum += width * std::fabs(gap);
  }
  return sum;
}

double ExpectedKolmogorovSmirnov(size_t m, size_t n) {
  if (m == 0 || n == 0) return 0;
  const double both = static_cast<double>(m) * static_cast<double>(n) / static_cast<double>(m + n);
  return std::sqrt(M_PI / 2) * std::log(2.0) / std::sqrt(both);
}

}  // namespace glint
