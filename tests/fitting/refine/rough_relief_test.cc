// Samples whose grain is relief under a wide lobe, which a smooth surface of varying albedo
// explains as long as normals are flat.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "fitting/refine/refine.h"
#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

using namespace test;

constexpr int kLeatherSize = 64;
constexpr float kLeatherRoughness = 0.5f;

// A dark dielectric with bumps a few texels wide, of this RMS slope along an axis.
SvbrdfMaps Leather(double slope) {
  SvbrdfMaps maps = LevelSubstance(kLeatherSize, kLeatherRoughness);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  constexpr int kWaves = 40;
  std::vector<double> p(maps.texels()), q(maps.texels());
  for (int wave = 0; wave < kWaves; ++wave) {
    const double turn = 2 * std::numbers::pi * wave / kWaves;
    const double length_texel = 4 + 4 * std::abs(normal(random)), phase = 6 * normal(random);
    const double x = std::cos(turn), y = std::sin(turn);
    for (size_t t = 0; t < maps.texels(); ++t) {
      const size_t column = t % kLeatherSize, row = t / kLeatherSize;
      const double along = x * static_cast<double>(column) + y * static_cast<double>(row);
      const double of_wave = slope * std::sqrt(4.0 / kWaves) *
                             std::cos(2 * std::numbers::pi * along / length_texel + phase);
      p[t] += of_wave * x;
      q[t] += of_wave * y;
    }
  }
  for (size_t t = 0; t < maps.texels(); ++t) {
    const double length = std::sqrt(1 + p[t] * p[t] + q[t] * q[t]);
    maps.plane(kNormalX)[t] = static_cast<float>(-p[t] / length);
    maps.plane(kNormalY)[t] = static_cast<float>(-q[t] / length);
    maps.plane(kNormalZ)[t] = static_cast<float>(1 / length);
    for (int c = 0; c < 3; ++c) {
      maps.plane(kDiffuseR + c)[t] *= c == 2 ? 0.2f : 0.05f;
      maps.plane(kSpecularR + c)[t] = 0.04f;
    }
  }
  return maps;
}

double RmsDifference(const SvbrdfMaps& a, const SvbrdfMaps& b, SvbrdfPlane plane) {
  double squares = 0;
  for (size_t t = 0; t < a.texels(); ++t) {
    const double difference = a.plane(plane)[t] - b.plane(plane)[t];
    squares += difference * difference / static_cast<double>(a.texels());
  }
  return std::sqrt(squares);
}

// Photographs that are off by what no maps explain, as where they are displaced by a texel.
SyntheticScene PhotographedBadly(const SvbrdfMaps& truth) {
  SyntheticScene scene = Photograph(truth, 7, 8);
  std::mt19937 random(31);
  std::normal_distribution<float> log_radiance(0.0f, 0.3f);
  for (std::vector<float>& photograph : scene.photographs) {
    for (size_t t = 0; t < truth.texels(); ++t) {
      const float factor = std::exp(log_radiance(random));
      for (size_t c = 0; c < 3; ++c) photograph[c * truth.texels() + t] *= factor;
    }
  }
  return scene;
}

TEST(Refine, GrainOfRoughReliefIsNotTakenForThatOfALevelSurface) {
  const double slope = 0.3;
  const SvbrdfMaps truth = Leather(slope);
  SvbrdfMaps start = LevelSubstance(kLeatherSize, 0.15f);
  for (int c = 0; c < 3; ++c) {
    std::ranges::fill(start.plane(kDiffuseR + c), c == 2 ? 0.03f : 0.01f);
  }
  const SyntheticScene scene = PhotographedBadly(truth);
  const RefineResult found = Refine(scene.Problem(), start, {}, 2);
  // 0.11; by means of the greatest likelihood 0.20.
  EXPECT_LT(RmsDifference(found.maps, truth, kNormalX), 0.5 * slope);
  EXPECT_GT(found.summary.one_roughness, 0);
  EXPECT_LT(RmsDifference(found.maps, truth, kRoughness), 0.2);
}

TEST(Refine, SubstancesOfTwoRoughnessesKeepTheirOwn) {
  SvbrdfMaps truth = LevelSubstance(32, 0.2f);
  for (size_t t = 0; t < truth.texels(); ++t) {
    if (t % 32 < 16) continue;
    truth.plane(kRoughness)[t] = 0.5f;
    truth.plane(kDiffuseR)[t] *= 3;
  }
  const SyntheticScene scene = Photograph(truth, 7, 8);
  const RefineResult found = Refine(scene.Problem(), DisturbedMaps(truth, 0.3f, 33), {}, 2);
  EXPECT_EQ(found.summary.one_roughness, 0);
  EXPECT_LT(RmsDifference(found.maps, truth, kRoughness), 0.02);
}

}  // namespace
}  // namespace glint
