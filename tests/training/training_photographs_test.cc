#include "training/training_photographs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/linearize/light_guess.h"
#include "fitting/encoding/encoding.h"
#include "fitting/estimator/estimator_descent.h"
#include "fitting/estimator/photograph_features.h"
#include "tests/training/toy_materials.h"
#include "training/capture_draw.h"
#include "training/guessed_power.h"

namespace glint {
namespace {

using torch::Tensor;

Tensor EncodedToys(int count) {
  std::vector<Tensor> list;
  for (int k = 0; k < count; ++k) {
    list.push_back(
        torch::tensor(EncodeMaps(ToyMaterial(static_cast<std::uint64_t>(k), 64, 64)).planes)
            .view({kEncodedChannels, 64, 64}));
  }
  return torch::stack(list);
}

TEST(TrainingPhotographs, AreFiniteWhateverIsDrawn) {
  const Tensor maps = EncodedToys(8);
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Stream random(StreamSeed(3, seed));
    const CaptureBatch seen =
        PhotographMaps(maps, 1 + static_cast<int>(seed % 3), CaptureQuality::kDrawn, &random);
    EXPECT_TRUE(seen.features.isfinite().all().item<bool>()) << seed;
    EXPECT_TRUE(seen.profiles.isfinite().all().item<bool>()) << seed;
  }
}

// A masked texel is beyond the frame: then all of its planes that photographs fill are 0.
TEST(TrainingPhotographs, ShowNoHolesWhereHighlightsClip) {
  const Tensor maps = EncodedToys(8);
  bool clips = false;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Stream random(StreamSeed(4, seed));
    const Tensor f = PhotographMaps(maps, 2, CaptureQuality::kDrawn, &random).features;
    const Tensor clipped = f.select(2, 3), mask = f.select(2, 4);
    EXPECT_EQ((clipped * (1 - mask)).sum().item<double>(), 0);
    clips = clips || clipped.sum().item<double>() > 0;
  }
  EXPECT_TRUE(clips);
}

TEST(TrainingPhotographs, ThreeInFiveUncalibratedCapturesHaveAGuessedPower) {
  int uncalibrated = 0, guessed = 0;
  for (std::uint64_t k = 0; k < 4000; ++k) {
    Stream random(StreamSeed(5, k));
    const DrawnCapture drawn = DrawCapture(CaptureKind::kPhone, 1, &random);
    uncalibrated += drawn.calibrated == 0;
    guessed += drawn.power_guessed > 0;
    EXPECT_FALSE(drawn.calibrated > 0 && drawn.power_guessed > 0);
  }
  EXPECT_NEAR(static_cast<double>(guessed) / uncalibrated, 0.6, 0.05);
}

// By what photographs of one capture are displaced against each other: on real sets .2 to 1.3
// texels at 256². A plane's height over the assumed one moves a texel by it times the ray's
// tangent.
TEST(TrainingPhotographs, AreMisplacedAsRealOnesAre) {
  constexpr double kTexels = 256, kWidth = 1.7;  // of samples, in the middle of what is drawn
  constexpr int kShots = 7;
  std::vector<double> rms;
  for (std::uint64_t k = 0; k < 400; ++k) {
    Stream random(StreamSeed(8, k));
    const DrawnCapture drawn = DrawCapture(CaptureKind::kPhone, kShots, &random);
    if (drawn.calibrated > 0) continue;
    const Disturbance& d = drawn.disturbance;
    double sum = 0, count = 0;
    for (const double x : {-0.8, 0.0, 0.8}) {
      for (const double y : {-0.8, 0.0, 0.8}) {
        const double height =
            d.plane_height * kWidth + (d.plane_slope_x * x + d.plane_slope_y * y) * kWidth / 2;
        std::array<double, kShots> right{}, up{};
        double mean_right = 0, mean_up = 0;
        for (size_t i = 0; i < kShots; ++i) {
          const Shot& shot = drawn.shots[i];
          const Vec3d& c = shot.view.camera_in_sample_mm;
          const double scale = height / c[2] * kTexels / kWidth;
          right[i] = (c[0] - x * kWidth / 2) * scale + shot.shift_x;
          up[i] = (c[1] - y * kWidth / 2) * scale + shot.shift_y;
          mean_right += right[i] / kShots;
          mean_up += up[i] / kShots;
        }
        for (size_t i = 0; i < kShots; ++i) {
          sum += std::pow(right[i] - mean_right, 2) + std::pow(up[i] - mean_up, 2);
          count += 1;
        }
      }
    }
    rms.push_back(std::sqrt(2 * sum / count));  // of the difference of two photographs
  }
  std::sort(rms.begin(), rms.end());
  const auto quantile = [&](double q) { return rms[static_cast<size_t>(q * rms.size())]; };
  RecordProperty("quantiles", std::to_string(quantile(0.1)) + " " + std::to_string(quantile(0.5)) +
                                  " " + std::to_string(quantile(0.9)));
  EXPECT_GT(quantile(0.1), 0.15);
  EXPECT_NEAR(quantile(0.5), 0.6, 0.2);
  EXPECT_LT(quantile(0.9), 1.5);
}

// Two photographs of a matte sample, one part of it beyond the second one's frame.
TEST(TrainingPhotographs, GuessTheLightsPowerAsProgramsDo) {
  constexpr int kWidth = 96, kHeight = 80;
  SamplePlane plane{kWidth, kHeight, 2.0, 2.0 * kHeight / kWidth, TexelSampling::kPixelCentres};
  for (const LightFalloff falloff : {LightFalloff::kInverseSquare, LightFalloff::kNone}) {
    std::vector<View> views(2);
    views[0].light_in_sample_mm = views[0].camera_in_sample_mm = {0.1, 0, 3};
    views[1].light_in_sample_mm = views[1].camera_in_sample_mm = {0.9, -0.3, 2.5};
    views[1].exposure = 1.3;
    torch::manual_seed(6);
    PhotographTensors seen{0.05 + 0.4 * torch::rand({1, 2, 3, kHeight, kWidth}),
                           torch::ones({1, 2, 1, kHeight, kWidth}), torch::ones({1, 2, 1, 1, 1})};
    seen.mask[0][1].slice(2, 70).zero_();
    LightGuess guess(plane, falloff);
    for (int n = 0; n < 2; ++n) {
      const Tensor rgb = seen.radiance[0][n].contiguous(), mask = seen.mask[0][n].contiguous();
      const float* values = rgb.data_ptr<float>();
      guess.Add(
          {kWidth, kHeight, std::vector<float>(values, values + rgb.numel()),
           std::vector<float>(mask.data_ptr<float>(), mask.data_ptr<float>() + mask.numel())});
    }
    const ViewBatch batch{plane, {DiffuseWeight::kOne, falloff, plane.sampling}, 2, views};
    const double power =
        GuessedPower(seen, TensorsOf(batch, torch::kFloat32), plane, falloff).item<double>();
    EXPECT_NEAR(power, guess.Power(views), 1e-4 * power);
  }
}

// What a learned descent sees of the true maps, of clean captures: next to nothing unexplained; and
// of others, a way down.
TEST(TrainingPhotographs, LeaveNothingUnexplainedByTheirOwnMaps) {
  const Tensor maps = EncodedToys(4);
  Stream random(7);
  const Tensor features = PhotographMaps(maps, 3, CaptureQuality::kClean, &random).features;
  EXPECT_LT(UnexplainedBy(maps, features).size.mean().item<double>(), 0.01);
  const Tensor other = (maps + 0.2).clamp(-0.99, 0.99);
  const Unexplained before = UnexplainedBy(other, features);
  const Unexplained after = UnexplainedBy(other - 0.05 * before.gradient.sign(), features);
  EXPECT_GT(before.size.mean().item<double>(), 0.05);
  EXPECT_LT(after.size.mean().item<double>(), 0.9 * before.size.mean().item<double>());
}

}  // namespace
}  // namespace glint
