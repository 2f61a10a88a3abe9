#include "calib/moving_light/lamp_strengths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "tests/calib/moving_light/lights_on_a_dome.h"

namespace glint {
namespace {

using Colours = std::vector<Eigen::Vector3d>;

constexpr int kSide = 20;

// Normal deviates that are the same with every standard library.
class Deviates {
 public:
  double operator()() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(engine_()) / 4294967296.0;
    return sum;
  }

 private:
  std::mt19937 engine_{7};
};

// A matte sample of 100 mm with some relief, under lamps of these strengths.
LampProblem MatteSample(const Colours& strengths) {
  LampProblem problem;
  for (const Eigen::Vector3d& light : testing::LightsOnADome(static_cast<int>(strengths.size()))) {
    problem.lights_mm.push_back(1000 * light);
  }
  Deviates deviate;
  std::vector<Eigen::Vector3d> normals, albedos;
  for (int i = 0; i < kSide * kSide; ++i) {
    const int column = i % kSide, row = i / kSide;
    problem.points_mm.emplace_back(100.0 * (column + 0.5) / kSide - 50,
                                   50 - 100.0 * (row + 0.5) / kSide, 0);
    const double slope_x = 0.08 * deviate(), slope_y = 0.08 * deviate();
    normals.push_back(Eigen::Vector3d(slope_x, slope_y, 1).normalized());
    albedos.emplace_back(0.3 * std::exp(0.4 * deviate()), 0.3 * std::exp(0.4 * deviate()),
                         0.3 * std::exp(0.4 * deviate()));
  }
  for (size_t v = 0; v < strengths.size(); ++v) {
    problem.radiance.emplace_back();
    for (size_t p = 0; p < normals.size(); ++p) {
      const Eigen::Vector3d to = (problem.lights_mm[v] - problem.points_mm[p]) / 1000;
      const double received = std::max(0.0, normals[p].dot(to.normalized())) / to.squaredNorm();
      const Eigen::Vector3d rgb = received * albedos[p].cwiseProduct(strengths[v]);
      problem.radiance.back().push_back(
          {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])});
    }
  }
  return problem;
}

double Log(const LampStrengths& found, size_t lamp) { return std::log(found.lamps[lamp].exposure); }

TEST(LampStrengths, LampsThatAreAlikeAreFoundToBe) {
  const LampStrengths found = EstimateLampStrengths(MatteSample(Colours(24, {1, 1, 1})), 2);
  ASSERT_EQ(found.lamps.size(), 24u);
  for (const LampStrength& lamp : found.lamps) {
    EXPECT_NEAR(lamp.exposure, 1, 0.02);
    EXPECT_LT((lamp.colour - Eigen::Vector3d::Ones()).norm(), 0.01);
    EXPECT_GT(lamp.used_share, 0.99);
  }
  EXPECT_NEAR(found.colour_sd, 0, 1e-5);
}

TEST(LampStrengths, LampThatDiffersFromAllOthersIsFound) {
  for (const double strength : {0.6, 1.7}) {
    Colours strengths(24, {1, 1, 1});
    strengths[9] *= strength;
    const LampStrengths found = EstimateLampStrengths(MatteSample(strengths), 2);
    const double truth = std::log(strength) * 23 / 24;
    EXPECT_NEAR(Log(found, 9), truth, 0.2 * std::abs(truth)) << strength;
    for (size_t v = 0; v < 24; ++v) {
      if (v == 9) continue;
      EXPECT_LT(std::abs(Log(found, v)), 0.3 * std::abs(truth)) << v;
    }
  }
}

TEST(LampStrengths, WhatIsSmoothOverTheDirectionsIsLeftToRefinement) {
  const auto lights = testing::LightsOnADome(40);
  Colours strengths;
  for (const Eigen::Vector3d& light : lights) {
    strengths.push_back(Eigen::Vector3d::Constant(std::exp(0.4 * light.x())));
  }
  const LampStrengths found = EstimateLampStrengths(MatteSample(strengths), 2);
  for (size_t v = 0; v < lights.size(); ++v) EXPECT_NEAR(Log(found, v), 0, 0.08) << v;
}

TEST(LampStrengths, MeanOfTheLogarithmsIsZeroAndTheProductOfAColourOne) {
  Deviates deviate;
  Colours strengths;
  for (int v = 0; v < 24; ++v) {
    const double grey = 0.2 * deviate();
    strengths.emplace_back(std::exp(grey + 0.2 * deviate()), std::exp(grey),
                           std::exp(grey + 0.2 * deviate()));
  }
  const LampStrengths found = EstimateLampStrengths(MatteSample(strengths), 2);
  double sum = 0;
  for (size_t v = 0; v < found.lamps.size(); ++v) {
    sum += Log(found, v);
    EXPECT_NEAR(found.lamps[v].colour.prod(), 1, 1e-9);
  }
  EXPECT_NEAR(sum, 0, 1e-9);
}

TEST(LampStrengths, ColoursOfLampsAreThoseOfTheLightButForWhatGlossMayFeign) {
  Deviates deviate;
  Colours strengths;
  std::vector<double> red;
  for (int v = 0; v < 24; ++v) {
    red.push_back(0.25 * deviate());
    strengths.emplace_back(std::exp(red.back()), 1, std::exp(0.25 * deviate()));
  }
  double mean = 0;
  for (const double value : red) mean += value / 24;
  const LampStrengths found = EstimateLampStrengths(MatteSample(strengths), 2);
  for (size_t v = 0; v < red.size(); ++v) {
    const Eigen::Vector3d& colour = found.lamps[v].colour;
    EXPECT_NEAR(std::log(colour[0] / colour[1]), red[v] - mean, 0.02 + 0.15 * std::abs(red[v]))
        << v;
  }
  EXPECT_NEAR(found.colour_sd, 0.25, 0.08);
}

// Lacquer on a coloured sample: toward the mirror direction every point is whiter.
void AddGloss(double strength, const Colours& lamps, LampProblem* problem) {
  for (size_t v = 0; v < lamps.size(); ++v) {
    const Eigen::Vector3d half =
        (problem->lights_mm[v].normalized() + Eigen::Vector3d::UnitZ()).normalized();
    const double gloss = strength * std::exp((half.z() - 1) / 0.02);
    for (auto& rgb : problem->radiance[v]) {
      for (size_t c = 0; c < 3; ++c) {
        rgb[c] += static_cast<float>(gloss * lamps[v][static_cast<Eigen::Index>(c)]);
      }
    }
  }
}

// Log red/green, about the mean.
std::vector<double> Reds(const std::vector<Eigen::Vector3d>& colours) {
  std::vector<double> reds;
  double mean = 0;
  for (const Eigen::Vector3d& colour : colours) {
    reds.push_back(std::log(colour[0] / colour[1]));
    mean += reds.back() / static_cast<double>(colours.size());
  }
  for (double& red : reds) red -= mean;
  return reds;
}

std::vector<double> RedsFound(const LampProblem& problem) {
  std::vector<Eigen::Vector3d> colours;
  for (const LampStrength& lamp : EstimateLampStrengths(problem, 2).lamps) {
    colours.push_back(lamp.colour);
  }
  return Reds(colours);
}

TEST(LampStrengths, GlossOfAColouredSampleIsNoColourOfALamp) {
  const Colours white(40, {1, 1, 1});
  LampProblem problem = MatteSample(white);
  for (auto& photo : problem.radiance) {
    for (auto& rgb : photo) rgb[0] *= 0.2f;  // blue-green
  }
  AddGloss(0.2, white, &problem);
  // As it looks: the mean over points of log red/green, from the lamp with least to that with most.
  std::vector<double> seen;
  for (const auto& photo : problem.radiance) {
    seen.push_back(0);
    for (const auto& rgb : photo) {
      seen.back() += std::log(rgb[0] / rgb[1]) / static_cast<double>(photo.size());
    }
  }
  const auto [least, most] = std::minmax_element(seen.begin(), seen.end());
  ASSERT_GT(*most - *least, 0.5);
  for (const double red : RedsFound(problem)) EXPECT_NEAR(red, 0, 0.08);
}

TEST(LampStrengths, ColoursThatChangeWithTheDirectionAreFoundOnASampleOfManyColours) {
  Colours lamps;
  for (const Eigen::Vector3d& light : testing::LightsOnADome(40)) {
    lamps.emplace_back(std::exp(0.25 * light.x()), 1, 1);
  }
  LampProblem problem = MatteSample(lamps);
  AddGloss(0.2, lamps, &problem);
  const std::vector<double> found = RedsFound(problem), truth = Reds(lamps);
  for (size_t v = 0; v < found.size(); ++v) EXPECT_NEAR(found[v], truth[v], 0.06) << v;
}

// Gilding mirrors some lamps and shows others dark.
TEST(LampStrengths, PointsThatAreNotMatteSayLittle) {
  Colours strengths(24, {1, 1, 1});
  strengths[9] *= 1.7;
  LampProblem problem = MatteSample(strengths);
  Deviates deviate;
  for (auto& photo : problem.radiance) {
    for (size_t p = 0; p < photo.size(); p += 3) {
      const auto factor = static_cast<float>(std::exp(1.0 * deviate()));
      for (float& value : photo[p]) value *= factor;
    }
  }
  const LampStrengths found = EstimateLampStrengths(problem, 2);
  EXPECT_NEAR(Log(found, 9), std::log(1.7) * 23 / 24, 0.12);
  for (size_t v = 0; v < 24; ++v) {
    if (v == 9) continue;
    EXPECT_LT(std::abs(Log(found, v)), 0.12) << v;
  }
}

TEST(LampStrengths, ClippedPointsAreLeftOut) {
  Colours strengths(24, {1, 1, 1});
  const LampProblem whole = MatteSample(strengths);
  LampProblem clipped = whole;
  for (size_t p = 0; p < clipped.radiance[2].size(); p += 2) {
    clipped.radiance[2][p] = {-1, -1, -1};
  }
  const LampStrengths found = EstimateLampStrengths(clipped, 2);
  EXPECT_NEAR(found.lamps[2].used_share, 0.5, 0.01);
  EXPECT_NEAR(Log(found, 2), 0, 0.03);
}

TEST(LampStrengths, PhotographThatIsClippedAllOverIsNoFault) {
  LampProblem problem = MatteSample(Colours(12, {1, 1, 1}));
  for (auto& rgb : problem.radiance[4]) rgb = {-1, -1, -1};
  const LampStrengths found = EstimateLampStrengths(problem, 2);
  EXPECT_EQ(found.lamps[4].used_share, 0);
  for (const LampStrength& lamp : found.lamps) {
    EXPECT_TRUE(std::isfinite(lamp.exposure));
    EXPECT_TRUE(lamp.colour.allFinite());
  }
}

TEST(LampStrengths, DoNotDependOnTheNumberOfThreads) {
  Colours strengths(24, {1, 1, 1});
  strengths[3] = {1.4, 1.1, 0.9};
  const LampProblem problem = MatteSample(strengths);
  const LampStrengths one = EstimateLampStrengths(problem, 1);
  const LampStrengths four = EstimateLampStrengths(problem, 4);
  for (size_t v = 0; v < one.lamps.size(); ++v) {
    EXPECT_EQ(one.lamps[v].exposure, four.lamps[v].exposure);
    EXPECT_EQ(one.lamps[v].colour, four.lamps[v].colour);
  }
  EXPECT_EQ(one.point_sd, four.point_sd);
}

TEST(LampStrengths, TwoPhotographsTellNone) {
  const LampStrengths found = EstimateLampStrengths(MatteSample({{1, 1, 1}, {2, 2, 2}}), 1);
  ASSERT_EQ(found.lamps.size(), 2u);
  for (const LampStrength& lamp : found.lamps) EXPECT_EQ(lamp.exposure, 1);
}

TEST(LampStrengths, NumbersThatDoNotFitAreRefused) {
  LampProblem problem = MatteSample(Colours(4, {1, 1, 1}));
  problem.radiance[1].pop_back();
  EXPECT_THROW(EstimateLampStrengths(problem, 1), std::invalid_argument);
  problem.radiance.pop_back();
  EXPECT_THROW(EstimateLampStrengths(problem, 1), std::invalid_argument);
}

}  // namespace
}  // namespace glint
