#include "calib/light/spot_cost.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace glint::light {
namespace {

constexpr std::array kSizes = {3, 3, 3, 3, 1, 1, 3, 3};

Spot SomeSpot() {
  Spot spot;
  spot.geometry.spot_in_camera_mm = {30, -20, 300};
  spot.geometry.normal_in_camera = Eigen::Vector3d(0.2, 0.1, -1).normalized();
  spot.geometry.r2 = 0.6;
  spot.geometry.smear = 0.3;
  spot.seen = {0.3, 0.4, 0.2};
  spot.sigma[0] = 0.01, spot.sigma[1] = 0.02, spot.sigma[2] = 0.015;
  return spot;
}

std::array<double, 3> Residuals(const SpotCost& cost,
                                const std::array<std::vector<double>, 8>& at) {
  std::array<const double*, 8> blocks;
  for (size_t b = 0; b < blocks.size(); ++b) blocks[b] = at[b].data();
  std::array<double, 3> residual{};
  EXPECT_TRUE(cost.Evaluate(blocks.data(), residual.data(), nullptr));
  return residual;
}

TEST(SpotCost, DerivativesAreThoseOfTheResiduals) {
  const Spot spot = SomeSpot();
  const SpotCost cost(spot, 1.2e-5, 2);
  std::array<std::vector<double>, 8> at = {{{12, -5, 3},
                                            {9.9, 10.1, 9.7},
                                            {0.1, 0.05, 0.2},
                                            {-0.3, 0.05, -0.02},
                                            {0.04},
                                            {0.1},
                                            {0.1, -0.05, 0.02},
                                            {0.2, -0.1, 0.05}}};
  std::array<const double*, 8> blocks;
  std::array<std::vector<double>, 8> jacobian;
  std::array<double*, 8> rows;
  for (size_t b = 0; b < blocks.size(); ++b) {
    blocks[b] = at[b].data();
    jacobian[b].resize(static_cast<size_t>(3 * kSizes[b]));
    rows[b] = jacobian[b].data();
  }
  std::array<double, 3> residual{};
  ASSERT_TRUE(cost.Evaluate(blocks.data(), residual.data(), rows.data()));
  EXPECT_EQ(residual, Residuals(cost, at));
  for (size_t b = 0; b < blocks.size(); ++b) {
    for (int i = 0; i < kSizes[b]; ++i) {
      const double step = 1e-5 * std::max(1.0, std::abs(at[b][i]));
      auto more = at, less = at;
      more[b][i] += step;
      less[b][i] -= step;
      const auto up = Residuals(cost, more), down = Residuals(cost, less);
      for (int c = 0; c < 3; ++c) {
        const double slope = (up[c] - down[c]) / (2 * step);
        EXPECT_NEAR(jacobian[b][kSizes[b] * c + i], slope, 1e-5 * std::abs(slope) + 1e-6)
            << "block " << b << ", number " << i << ", channel " << c;
      }
    }
  }
}

TEST(SpotCost, HeldBlocksAreLeftAlone) {
  const Spot spot = SomeSpot();
  const SpotCost cost(spot, 1.2e-5, 2);
  const std::vector<double> three = {0, 0, 0}, one = {0};
  const std::array blocks = {three.data(), three.data(), three.data(), three.data(),
                             one.data(),   one.data(),   three.data(), three.data()};
  std::array<double*, 8> rows{};
  std::array<double, 9> by_exposure{};
  rows.back() = by_exposure.data();
  std::array<double, 3> residual{};
  ASSERT_TRUE(cost.Evaluate(blocks.data(), residual.data(), rows.data()));
  EXPECT_LT(by_exposure[0], 0);
  EXPECT_EQ(by_exposure[1], 0);
}

TEST(SpotCost, NoLightReachesAPaperThatIsTurnedAway) {
  Spot spot = SomeSpot();
  spot.geometry.normal_in_camera = {0, 0, 1};
  const SpotCost cost(spot, 1.2e-5, 2);
  const std::vector<double> three = {0, 0, 0}, one = {0};
  const std::array blocks = {three.data(), three.data(), three.data(), three.data(),
                             one.data(),   one.data(),   three.data(), three.data()};
  std::array<double, 3> residual{};
  EXPECT_FALSE(cost.Evaluate(blocks.data(), residual.data(), nullptr));
}

}  // namespace
}  // namespace glint::light
