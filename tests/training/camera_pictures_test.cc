#include "training/camera_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fitting/encoding/encoding.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr int kSide = 64;

double Most(const Tensor& t) { return t.abs().max().item<double>(); }

float At(const Tensor& t, int64_t row, int64_t column) {
  return t.select(-2, row).select(-1, column).flatten()[0].item<float>();
}

// Encoded maps of the surface z = a·cos(2π·x/S)·cos(4π·y/S), lengths in texels, y upward.
Tensor EncodedWaves(double a) {
  SvbrdfMaps maps(kSide, kSide);
  const double u = 2 * std::numbers::pi / kSide;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const double x = column * u, y = -row * 2 * u;
      const double zx = -a * u * std::sin(x) * std::cos(y);
      const double zy = -a * 2 * u * std::cos(x) * std::sin(y);
      const double length = std::sqrt(zx * zx + zy * zy + 1);
      maps.at(kNormalX, row, column) = static_cast<float>(-zx / length);
      maps.at(kNormalY, row, column) = static_cast<float>(-zy / length);
      maps.at(kNormalZ, row, column) = static_cast<float>(1 / length);
    }
  }
  const EncodedMaps encoded = EncodeMaps(maps);
  return torch::tensor(encoded.planes).view({1, kEncodedChannels, kSide, kSide});
}

TEST(CameraPictures, HeightsAreThoseOfTheSurfaceWhoseNormalsAreGiven) {
  const double a = 2.5;
  const Tensor heights = HeightsOf(EncodedWaves(a));
  for (const auto& [row, column] : {std::pair{0, 0}, {5, 9}, {16, 0}, {40, 33}}) {
    const double expected = a * std::cos(2 * std::numbers::pi * column / kSide) *
                            std::cos(4 * std::numbers::pi * row / kSide);
    EXPECT_NEAR(At(heights, row, column), expected, 0.02) << row << " " << column;
  }
  EXPECT_LT(std::abs(heights.mean().item<double>()), 1e-4);
}

TEST(CameraPictures, AWallShadesTheSideAwayFromTheLight) {
  Tensor heights = torch::zeros({1, 1, kSide, kSide});
  heights.slice(3, 30, 33).fill_(4);
  const auto towards = [&](double x, double z) {
    const double length = std::sqrt(x * x + z * z);
    Tensor light = torch::zeros({1, 1, 3, kSide, kSide});
    light.select(2, 0).fill_(x / length);
    light.select(2, 2).fill_(z / length);
    return LitShare(heights, light);
  };
  EXPECT_EQ(Most(1 - towards(0, 1)), 0);
  const Tensor from_right = towards(1, 1);
  EXPECT_EQ(At(from_right, 20, 28), 0);  // two texels to the left: under a ray that rises by two
  EXPECT_EQ(At(from_right, 20, 34), 1);
  EXPECT_EQ(At(from_right, 20, 20), 1);  // beyond the shadow's end
}

TEST(CameraPictures, DisplacedByWholeTexelsTheyAreCopied) {
  torch::manual_seed(1);
  const Tensor pictures = torch::rand({1, 2, 3, 16, 16});
  const Tensor offset = torch::full({1, 2, 1, 1, 1}, 2.0);
  const Tensor moved = Displaced(pictures, offset, torch::zeros_like(offset));
  EXPECT_LT(Most(moved.slice(4, 0, 14) - pictures.slice(4, 2)), 1e-5);
  const Tensor down = Displaced(pictures, torch::zeros_like(offset), offset);
  EXPECT_LT(Most(down.slice(3, 0, 14) - pictures.slice(3, 2)), 1e-5);
}

TEST(CameraPictures, AToeHalvesItsOwnRadianceAndLeavesTheBright) {
  const Tensor toe = torch::full({1, 1, 1, 1, 1}, 0.01);
  const Tensor pictures = torch::tensor({0.0, 0.01, 0.5}).view({1, 1, 3, 1, 1});
  const Tensor crushed = Crushed(pictures, toe).flatten();
  EXPECT_EQ(crushed[0].item<double>(), 0);
  EXPECT_NEAR(crushed[1].item<double>(), 0.005, 1e-6);
  EXPECT_NEAR(crushed[2].item<double>(), 0.49, 1e-3);
  EXPECT_LT(Most(Crushed(pictures, torch::zeros_like(toe)) - pictures), 1e-6);
}

TEST(CameraPictures, JpegKeepsFlatGreyAndCostsDetailByItsQuality) {
  const Tensor quality = torch::tensor({85.0f, 97.0f});
  const Tensor grey = torch::full({2, 1, 3, 32, 32}, 100.0f / 255);
  EXPECT_LT(Most(AfterJpeg(grey, quality) - grey), 1.1 / 255);
  torch::manual_seed(2);
  const Tensor rough =
      (0.5 + 0.1 * torch::randn({1, 1, 1, 32, 32}).expand({-1, -1, 3, -1, -1})).clamp(0, 1);
  const Tensor error =
      (AfterJpeg(rough.expand({2, -1, -1, -1, -1}), quality) - rough).select(2, 1).square();
  const double low = error[0].mean().sqrt().item<double>();
  const double high = error[1].mean().sqrt().item<double>();
  EXPECT_GT(low, 1.3 * high);
  EXPECT_LT(low, 0.1);
  EXPECT_GT(high, 1.0 / 255);
}

}  // namespace
}  // namespace glint
