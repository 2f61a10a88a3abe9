// What refinement makes of relief: normals are those of one height field, facets are none.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fitting/refine/refine.h"
#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

constexpr int kSide = 48;

// A glossy substance whose slopes are those of waves.
SvbrdfMaps WaveMaps() {
  SvbrdfMaps maps = test::LevelSubstance(kSide, 0.4f);
  for (size_t t = 0; t < maps.texels(); ++t) {
    const int row = static_cast<int>(t) / kSide, column = static_cast<int>(t) % kSide;
    const double wave = 0.25 * std::cos(0.5 * column + 0.35 * row);
    const double x = 0.5 * wave, y = -0.35 * wave, length = std::sqrt(1 + x * x + y * y);
    maps.plane(kNormalX)[t] = static_cast<float>(x / length);
    maps.plane(kNormalY)[t] = static_cast<float>(y / length);
    maps.plane(kNormalZ)[t] = static_cast<float>(1 / length);
  }
  return maps;
}

void AddWhiteNoise(float sd, test::SyntheticScene* scene) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal(0, sd);
  for (std::vector<float>& photograph : scene->photographs) {
    for (float& radiance : photograph) radiance *= std::exp(normal(random));
  }
}

// By whether all texels are at hand for the estimate, or one in three by three.
TEST(SampleRelief, AReliefHasNoFacets) {
  const test::SyntheticScene scene = test::Photograph(WaveMaps(), 7);
  for (const int size : {kSide, kSide / 3}) {
    RefineOptions options;
    options.estimation_size = size;
    options.second_lobe = false;
    EXPECT_LT(Refine(scene.Problem(), scene.truth, options, 2).summary.facet_spread, 0.01) << size;
  }
}

// Mean square of what refinement leaves wrong with normals, with as many passes.
double NormalError(const test::SyntheticScene& scene, int passes) {
  RefineOptions options;
  options.neighbour_passes = passes;
  options.second_lobe = false;
  const SvbrdfMaps start = test::DisturbedMaps(scene.truth, 0.3f, 9);
  return test::MeanSquare(Refine(scene.Problem(), start, options, 2).maps, scene.truth, kNormalX,
                          kNormalY);
}

TEST(SampleRelief, NormalsLoseErrorsThatNoHeightFieldHas) {
  test::SyntheticScene scene = test::Photograph(WaveMaps(), 7);
  AddWhiteNoise(0.1f, &scene);
  EXPECT_LT(NormalError(scene, 2), 0.3 * NormalError(scene, 0));
}

// Flakes and grains smaller than a texel look in directions of their own.
TEST(SampleRelief, FacetsKeepTheirNormals) {
  test::SyntheticScene scene = test::Photograph(test::QuarteredMaps(kSide, 3), 9);
  AddWhiteNoise(0.03f, &scene);
  EXPECT_LT(NormalError(scene, 2), 1.2 * NormalError(scene, 0));
}

}  // namespace
}  // namespace glint
