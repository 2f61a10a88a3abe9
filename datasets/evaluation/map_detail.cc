#include "datasets/evaluation/map_detail.h"

#include <cmath>
#include <stdexcept>

namespace glint {
namespace {

// Sums over neighbours of the squared differences of each, and of the products.
struct Sums {
  double estimate = 0, truth = 0, both = 0;
  void Add(double of_estimate, double of_truth, double weight) {
    estimate += weight * of_estimate * of_estimate;
    truth += weight * of_truth * of_truth;
    both += weight * of_estimate * of_truth;
  }
};

void AddPlane(const SvbrdfMaps& estimate, const SvbrdfMaps& truth, int plane, double weight,
              Sums* sums) {
  const int width = truth.width, height = truth.height;
  const auto e = estimate.plane(plane), t = truth.plane(plane);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const size_t i = static_cast<size_t>(row) * width + column;
      const auto add = [&](size_t next) {
        sums->Add(static_cast<double>(e[next]) - e[i], static_cast<double>(t[next]) - t[i], weight);
      };
      if (column + 1 < width) add(i + 1);
      if (row + 1 < height) add(i + static_cast<size_t>(width));
    }
  }
}

}  // namespace

MapDetail CompareDetail(const SvbrdfMaps& estimate, const SvbrdfMaps& truth) {
  if (estimate.width != truth.width || estimate.height != truth.height || truth.width < 2 ||
      truth.height < 2) {
    throw std::invalid_argument("maps to compare must have one size, of at least 2 × 2 texels");
  }
  Sums sums;
  constexpr double kThird = 1.0 / 3;
  for (int p = kDiffuseR; p <= kSpecularB; ++p) AddPlane(estimate, truth, p, kThird, &sums);
  AddPlane(estimate, truth, kRoughness, 1, &sums);
  // (n + 1)/2 halves differences and so quarters their squares.
  for (int p = kNormalX; p <= kNormalZ; ++p) AddPlane(estimate, truth, p, kThird / 4, &sums);
  if (!(sums.truth > 0)) return {};
  return {sums.estimate / sums.truth,
          sums.estimate > 0 ? sums.both / std::sqrt(sums.estimate * sums.truth) : 0};
}

}  // namespace glint
