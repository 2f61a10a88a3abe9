#include "fitting/view_correction/residual_noise.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace glint {
namespace {

constexpr int kNoisyViews = 12, kNoisyTexels = 4000;
constexpr double kNoiseVariance = 4e-4;

BatchObservations ObservationsOf(int views) {
  BatchObservations observations(views);
  observations.Clear(views);
  observations.Place(0, 0, 0);
  View view;
  view.camera_in_sample_mm = view.light_in_sample_mm = {0, 0, 300};
  const float radiance[3] = {0.2f, 0.2f, 0.2f};
  const bool clipped[3] = {false, false, false};
  for (int v = 0; v < views; ++v) {
    observations.Set(0, v, radiance, clipped);
    observations.Complete(v, BatchView(view, LightFalloff::kInverseSquare));
  }
  return observations;
}

// Residuals of which `common` of the variance is all channels' of a view. A solution takes away
// what nine parameters can follow: five degrees of freedom of the channels' sum, four of the rest.
class NoisyResiduals {
 public:
  NoisyResiduals(double common, unsigned seed) : common_(common), engine_(seed) {}

  void Fill(int views, BatchResiduals* residuals) {
    const double kept_common = std::sqrt((views - 5.0) / views);
    const double kept_rest = std::sqrt((2.0 * views - 4) / (2.0 * views));
    for (int v = 0; v < views; ++v) {
      const double shared = std::sqrt(common_) * normal_(engine_);
      std::array<double, 3> values{};
      double mean = 0;
      for (double& value : values) {
        value = shared + std::sqrt(1 - common_) * normal_(engine_);
        mean += value / 3;
      }
      for (size_t c = 0; c < 3; ++c) {
        const double left = kept_common * mean + kept_rest * (values[c] - mean);
        residuals->rows()[(3 * static_cast<size_t>(v) + c) * BatchResiduals::kRows +
                          BatchResiduals::kResidual][0] =
            static_cast<float>(std::sqrt(kNoiseVariance) * left);
      }
    }
  }

 private:
  double common_;
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

ResidualNoise Collected(double common, int views, unsigned seed) {
  const BatchObservations observations = ObservationsOf(views);
  BatchResiduals residuals(views);
  NoisyResiduals random(common, seed);
  ResidualNoise noise;
  for (int t = 0; t < kNoisyTexels; ++t) {
    random.Fill(views, &residuals);
    noise.Add(observations, residuals, 0, kNoiseVariance);
  }
  return noise;
}

// Of n residuals with correlation ρ the mean has the variance of n/(1 + (n − 1)ρ) independent ones.
TEST(ResidualNoise, CountsChannelsByTheirCorrelation) {
  for (const double correlation : {0.0, 0.25, 0.5, 0.9, 1.0}) {
    EXPECT_NEAR(Collected(correlation, kNoisyViews, 3).Shared(), 1 + 2 * correlation, 0.05)
        << correlation;
  }
}

TEST(ResidualNoise, IsTheSameInParts) {
  ResidualNoise both = Collected(0.2, kNoisyViews, 5);
  both.Add(Collected(0.8, kNoisyViews, 6));
  EXPECT_NEAR(both.Shared(), 1 + 2 * 0.5, 0.05);
}

TEST(ResidualNoise, TellsNothingOfTexelsThatFewViewsSee) {
  EXPECT_EQ(Collected(1, 6, 7).Shared(), 1);
  EXPECT_GT(Collected(1, 7, 7).Shared(), 2.9);
  EXPECT_EQ(ResidualNoise().Shared(), 1);
}

}  // namespace
}  // namespace glint
