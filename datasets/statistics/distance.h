// How far two one-dimensional distributions lie apart.
#pragma once

#include <span>
#include <vector>

namespace glint {

// Largest gap between the two cumulative distributions (Kolmogorov–Smirnov), 0 … 1: needs no unit,
// 0 only for equal samples. 1 when exactly one side is empty.
double KolmogorovSmirnov(std::vector<double> a, std::vector<double> b);

// Mean distance that values must move to turn one distribution into the other (Wasserstein-1), in
// the values' unit. 0 when either side is empty.
double Wasserstein(std::vector<double> a, std::vector<double> b);

// The same of histograms of equal bins; shares sum to 1; `width` is one bin's.
double HistogramKolmogorovSmirnov(std::span<const double> a, std::span<const double> b);
double HistogramWasserstein(std::span<const double> a, std::span<const double> b, double width);

// The Kolmogorov–Smirnov distance that two samples of one and the same distribution show on
// average, by their finite number alone: √(π/2)·ln 2 / √(mn/(m+n)).
double ExpectedKolmogorovSmirnov(size_t m, size_t n);

}  // namespace glint
