#include "datasets/statistics/spectrum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "datasets/statistics/fourier.h"

namespace glint {
namespace {

constexpr int kWaveSide = 128;

template <typename Function>
std::vector<float> Plane(Function value) {
  std::vector<float> plane;
  for (int y = 0; y < kWaveSide; ++y) {
    for (int x = 0; x < kWaveSide; ++x) plane.push_back(static_cast<float>(value(x, y)));
  }
  return plane;
}

std::vector<float> WhiteNoise() {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 0.3);
  return Plane([&](int, int) { return normal(random); });
}

TEST(FourierTest, InverseReturnsWhatWasTransformed) {
  const std::vector<float> noise = WhiteNoise();
  std::vector<Complex> wave(noise.begin(), noise.end());
  Fourier2d(&wave, kWaveSide);
  InverseFourier2d(&wave, kWaveSide);
  for (size_t i = 0; i < noise.size(); ++i) ASSERT_NEAR(wave[i].real(), noise[i], 1e-9);
}

TEST(FourierTest, RefusesPlanesOfAnotherSize) {
  std::vector<Complex> wave(36);
  EXPECT_THROW(Fourier2d(&wave, 8), std::invalid_argument);
}

TEST(SpectrumTest, AWavePeaksInItsBandAtAnyAngle) {
  for (const auto& [fx, fy] : {std::pair{6, 0}, {0, 21}, {9, 12}, {40, 3}}) {
    const auto plane = Plane([&, fx = fx, fy = fy](int x, int y) {
      return std::cos(2 * M_PI * (fx * x + fy * y) / kWaveSide);
    });
    const RadialSpectrum power = PowerSpectrum(plane, kWaveSide);
    const int peak = static_cast<int>(std::max_element(power.begin(), power.end()) - power.begin());
    EXPECT_EQ(peak, static_cast<int>(2 * std::log2(std::hypot(fx, fy)))) << fx << " " << fy;
  }
}

TEST(SpectrumTest, WhiteNoiseIsLevelAndItsPowerSumsToTheVariance) {
  const RadialSpectrum power = PowerSpectrum(WhiteNoise(), kWaveSide);
  EXPECT_NEAR(SpectralSlope(power), 0, 0.1);
  const double per_coefficient = 0.09 / (kWaveSide * kWaveSide);
  for (int band = 6; band < 12; ++band) {
    EXPECT_NEAR(power[static_cast<size_t>(band)] / per_coefficient, 1, 0.2) << band;
  }
}

TEST(SpectrumTest, SlopeIsThePowerLaws) {
  RadialSpectrum power;
  for (int band = 0; band < kSpectrumBands; ++band) {
    power[static_cast<size_t>(band)] = 0.1 * std::pow(BandFrequency(band), -2.4);
  }
  EXPECT_NEAR(SpectralSlope(power), -2.4, 1e-9);
}

TEST(SpectrumTest, HeightComesBackFromItsSlopes) {
  const double u = 2 * M_PI * 6 / kWaveSide, v = 2 * M_PI * 9 / kWaveSide;
  const auto height = [&](double x, double y) {
    return 2 * std::sin(u * x) + std::cos(v * y + u * x);
  };
  const auto truth = Plane([&](int x, int y) { return height(x, -y); });
  const auto slope_x =
      Plane([&](int x, int y) { return 2 * u * std::cos(u * x) - u * std::sin(-v * y + u * x); });
  const auto slope_y = Plane([&](int x, int y) { return -v * std::sin(-v * y + u * x); });
  const auto found = HeightFromSlopes(slope_x, slope_y, kWaveSide, 4);
  for (size_t i = 0; i < truth.size(); ++i) ASSERT_NEAR(found[i], truth[i], 1e-4) << i;
  const auto fine =
      HeightFromSlopes(slope_x, slope_y, kWaveSide, 8);  // the slower wave is left out
  EXPECT_GT(std::fabs(fine[16] - truth[16]), 0.5);
}

}  // namespace
}  // namespace glint
