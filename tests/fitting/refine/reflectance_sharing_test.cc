// What texels of a substance share.
#include "fitting/refine/refine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

using test::DisturbedMaps;
using test::LevelSubstance;
using test::MeanSquare;
using test::Photograph;
using test::QuarteredMaps;
using test::SyntheticScene;

// One substance under a smooth disturbance of its initial maps: where no photograph shows its
// highlight it is what it is elsewhere.
TEST(Refine, OneSubstanceBecomesNearlyHomogeneous) {
  const SvbrdfMaps truth = LevelSubstance(32, 0.3f);
  const SyntheticScene scene = Photograph(truth, 5, 8);
  SvbrdfMaps start = truth;
  for (size_t t = 0; t < truth.texels(); ++t) {
    const auto wave = static_cast<float>(std::sin(0.2 * static_cast<double>(t % 32)));
    start.plane(kRoughness)[t] += 0.12f * wave;
    for (int c = 0; c < 3; ++c) start.plane(kSpecularR + c)[t] *= 1 + 0.6f * wave;
  }
  const RefineResult result = Refine(scene.Problem(), start, {}, 1);
  EXPECT_LT(MeanSquare(result.maps, truth, kRoughness, kRoughness),
            0.02 * MeanSquare(start, truth, kRoughness, kRoughness));
  EXPECT_LT(MeanSquare(result.maps, truth, kSpecularR, kSpecularB),
            0.05 * MeanSquare(start, truth, kSpecularR, kSpecularB));
}

// Cloth, felt, asphalt: a lobe as rough as this hardly differs from diffuse light, and takes its
// place where nothing is known of how much dielectrics reflect.
TEST(Refine, DarkRoughDielectricsReflectWhatDielectricsDo) {
  SvbrdfMaps truth = QuarteredMaps(32, 3);
  for (size_t t = 0; t < truth.texels(); ++t) {
    truth.plane(kNormalX)[t] = truth.plane(kNormalY)[t] = 0;
    truth.plane(kNormalZ)[t] = 1;
    truth.plane(kRoughness)[t] = 0.85f;
    for (int c = 0; c < 3; ++c) {
      truth.plane(kDiffuseR + c)[t] *= 0.1f;
      truth.plane(kSpecularR + c)[t] = 0.04f;
    }
  }
  SvbrdfMaps start = truth;
  for (size_t t = 0; t < truth.texels(); ++t) {
    for (int c = 0; c < 3; ++c) {
      start.plane(kDiffuseR + c)[t] *= 0.4f;
      start.plane(kSpecularR + c)[t] = 0.12f;
    }
  }
  const SyntheticScene scene = Photograph(truth, 8, 8);
  const auto error = [&](double light_power_spread) {
    RefineOptions options;
    options.kinds.light_power_spread = light_power_spread;
    const SvbrdfMaps found = Refine(scene.Problem(), start, options, 1).maps;
    return std::sqrt(MeanSquare(found, truth, kSpecularR, kSpecularB));
  };
  EXPECT_LT(error(0.1), 0.015);
  EXPECT_GT(error(10), 1.5 * error(0.1));
}

// One level substance; roughness and specular albedo of texel t: .3 + roughness(t), .05 · (1 +
// specular(t)).
template <class Roughness, class Specular>
RefineSummary SummaryOf(const Roughness& roughness, const Specular& specular,
                        const RefineOptions& options = {}) {
  SvbrdfMaps truth(32, 32);
  for (size_t t = 0; t < truth.texels(); ++t) {
    truth.plane(kNormalZ)[t] = 1;
    truth.plane(kRoughness)[t] = 0.3f + static_cast<float>(roughness(t));
    for (int c = 0; c < 3; ++c) {
      truth.plane(kDiffuseR + c)[t] = 0.1f;
      truth.plane(kSpecularR + c)[t] = 0.05f * (1 + static_cast<float>(specular(t)));
    }
  }
  SvbrdfMaps start = truth;
  for (size_t t = 0; t < truth.texels(); ++t) {
    start.plane(kRoughness)[t] = 0.35f;
    for (int c = 0; c < 3; ++c) start.plane(kSpecularR + c)[t] = 0.06f;
  }
  return Refine(Photograph(truth, 10, 8).Problem(), start, options, 1).summary;
}

double Wave(size_t texel) {
  const size_t row = texel / 32, column = texel % 32;
  return std::sin(0.4 * static_cast<double>(row + column));
}
double Scatter(size_t texel) { return Wave(texel * 7919 % 1024); }  // the same values elsewhere
double Nothing(size_t) { return 0; }

// What neighbours tell of a texel is estimated, not assumed. (Several substances would be told
// apart by their gloss, and departures from them tell nothing of each other.)
TEST(Refine, NeighboursAgreeAsFarAsTheSamplesDo) {
  RefineOptions one;
  one.substances = 1;
  const auto smooth = [](size_t t) { return 0.1 * Wave(t); };
  const auto rough = [](size_t t) { return 0.1 * Scatter(t); };
  const auto between_neighbours = [&](const auto& roughness) {
    const RefineSummary s = SummaryOf(roughness, Nothing, one);
    return s.neighbour_spread * s.roughness_spread;
  };
  const double of_rough = between_neighbours(rough);
  EXPECT_GT(of_rough, 0.05);
  EXPECT_LT(between_neighbours(smooth), 0.6 * of_rough);
}

// Roughness may vary within a substance where specular albedo does not, and is then no reason to
// expect that it does.
TEST(Refine, SpecularAlbedoVariesByItsOwnMeasure) {
  const auto roughness = [](size_t t) { return 0.1 * Scatter(t); };
  const RefineSummary constant = SummaryOf(roughness, Nothing);
  const RefineSummary varying =
      SummaryOf(roughness, [](size_t t) { return 0.6 * Scatter(t + 500); });
  EXPECT_LT(constant.specular_spread / constant.roughness_spread,
            0.6 * varying.specular_spread / varying.roughness_spread);
}

// Few colours, so that substances have one diffuse albedo each, or colours of all kinds.
TEST(Refine, DiffuseAlbedoIsSharedAsFarAsSubstancesHaveOne) {
  const auto spread_of = [](const auto& value) {
    SvbrdfMaps truth = QuarteredMaps(32, 41);
    for (size_t t = 0; t < truth.texels(); ++t) {
      for (size_t c = 0; c < 3; ++c) {
        truth.plane(kDiffuseR + static_cast<int>(c))[t] =
            0.3f + 0.25f * value(Scatter(t + 300 * c));
      }
    }
    const RefineSummary s =
        Refine(Photograph(truth, 4, 8).Problem(), DisturbedMaps(truth, 0.5f, 33), {}, 1).summary;
    return s.diffuse_spread;
  };
  const auto either = [](double wave) { return wave > 0 ? 1.0f : -1.0f; };
  const auto any = [](double wave) { return static_cast<float>(wave); };
  EXPECT_LT(spread_of(either), 0.7 * spread_of(any));
}

}  // namespace
}  // namespace glint
