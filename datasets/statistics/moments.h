// Moments and correlations of planes.
#pragma once

#include <span>

namespace glint {

struct Moments {
  double mean = 0, spread = 0;  // spread: standard deviation
  double skewness = 0;          // 0 when the spread is 0
  double kurtosis = 0;          // of a normal distribution: 3; 0 when the spread is 0
};
Moments MomentsOf(std::span<const float> plane);

// Pearson's correlation. NaN when either plane is flat: its spread below 1e-4.
double Correlation(std::span<const float> a, std::span<const float> b);

// Correlation of what is as fine as texels: of both planes' differences from the mean of their four
// neighbours. NaN as above.
double FineCorrelation(std::span<const float> a, std::span<const float> b, int width);

// How much a plane's gradients share one direction: (λ1 − λ2) / (λ1 + λ2) of the mean structure
// tensor, 0 … 1. 0 for a flat plane.
double Directionality(std::span<const float> plane, int width);

}  // namespace glint
