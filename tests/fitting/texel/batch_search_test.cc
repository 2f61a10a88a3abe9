#include "fitting/texel/batch_search.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "tests/fitting/texel/random_lanes.h"

namespace glint {
namespace {

using kernel::BatchSolution;
using test::Draw;
using test::kViews;
using test::Lanes;
using test::RandomTexel;

// Gives the lanes' observations of these ids, which may repeat.
BatchSearch::Gather GatherFrom(const BatchObservations& all) {
  return [&all](std::span<const size_t> ids, BatchObservations* observations) {
    observations->Clear(kViews);
    for (size_t i = 0; i < ids.size(); ++i) {
      observations->CopyLane(all, static_cast<int>(ids[i] % kBatch), static_cast<int>(i));
    }
    return observations;
  };
}

TEST(BatchSearch, EveryTaskIsDoneWhateverTheirNumber) {
  Seen seen;
  BatchSearch search(seen.lanes.options, 40, kViews, 2);
  search.SetNoise(0.01);
  for (const size_t count : {1, 16, 37, 100}) {
    std::vector<int> done(count, 0);
    search.Begin(BatchSearch::From::kStart, GatherFrom(seen.lanes.observations),
                 [&](const BatchSearch::Task& task, const BatchSearch::Found& found) {
                   ++done[task.id];
                   EXPECT_LE(found.solution.cost, found.solution.start_cost);
                   EXPECT_NEAR(found.solution.values[kRough], seen.truth[task.id % kBatch][kRough],
                               5e-3);
                 });
    for (size_t id = 0; id < count; ++id) {
      search.Add({.id = id, .prior = {}, .start = seen.lanes.texels[id % kBatch]});
    }
    search.Finish();
    EXPECT_EQ(done, std::vector<int>(count, 1));
  }
}

// Of `rounds` · kBatch texels that `draw` makes, how many the search does not find from `start`.
int Misses(
    int rounds, const std::function<TexelValues(std::mt19937*)>& draw, const TexelValues& start,
    const TexelPrior& prior,
    const std::function<bool(const TexelValues& found, const TexelValues& truth)>& is_found) {
  std::mt19937 random(7);
  int missed = 0;
  for (int round = 0; round < rounds; ++round) {
    Lanes lanes(&random);
    lanes.options = {};
    std::array<TexelValues, kBatch> truth;
    for (TexelValues& texel : truth) texel = draw(&random);
    lanes.ShadeWith(truth);
    lanes.Observe();
    BatchSearch search(lanes.options, 40, kViews, 3);
    search.SetNoise(0.003);
    search.Begin(BatchSearch::From::kStart, GatherFrom(lanes.observations),
                 [&](const BatchSearch::Task& task, const BatchSearch::Found& found) {
                   if (!is_found(found.solution.values, truth[task.id])) ++missed;
                 });
    for (size_t id = 0; id < kBatch; ++id) {
      search.Add({.id = id, .prior = prior, .start = start});
    }
    search.Finish();
  }
  return missed;
}

TexelValues GreyTexel(double diffuse, double specular, double rough, double slope_x,
                      double slope_y) {
  TexelValues texel;
  for (int c = 0; c < 3; ++c) {
    texel[DiffuseParameter(c)] = diffuse;
    texel[SpecularParameter(c)] = specular;
  }
  texel[kRough] = rough;
  texel[kSlopeX] = slope_x;
  texel[kSlopeY] = slope_y;
  return texel;
}

// From a level start steep matte texels come to lie in a minimum without diffuse light, whose wide
// specular lobe explains the shading.
TEST(BatchSearch, SteepMatteTexelsAreFoundFromALevelStart) {
  constexpr int kRounds = 60;
  const auto steep = [](std::mt19937* random) {
    const double tilt = Draw(random, 1.2, 1.8), azimuth = Draw(random, 0, 6.28);
    return GreyTexel(0.3, 0.04, 0.6, tilt * std::cos(azimuth), tilt * std::sin(azimuth));
  };
  const auto same_normal = [](const TexelValues& found, const TexelValues& truth) {
    return std::hypot(found[kSlopeX] - truth[kSlopeX], found[kSlopeY] - truth[kSlopeY]) < 0.1;
  };
  EXPECT_LT(Misses(kRounds, steep, GreyTexel(0.05, 0.3, 0.8, 0, 0), {}, same_normal),
            0.05 * kRounds * kBatch);
}

// On the flank of a highlight a dark and rough texel explains what a smooth one shows, and from
// there other roughnesses alone lead nowhere.
TEST(BatchSearch, TexelsLikeTheOthersOfTheirSubstanceAreFoundFromAPoorStart) {
  constexpr int kRounds = 60;
  const auto smooth = [](std::mt19937* random) {
    return GreyTexel(0.04, 0.045, Draw(random, 0.13, 0.2), Draw(random, -0.02, 0.02),
                     Draw(random, -0.02, 0.02));
  };
  const auto same_roughness = [](const TexelValues& found, const TexelValues& truth) {
    return std::abs(std::log(found[kRough] / truth[kRough])) < 0.2;
  };
  const TexelPrior of_substance(
      TexelGaussian(GreyTexel(0.045, 0.045, 0.165, 0, 0), InitialisationErrors()), 0.003);
  EXPECT_LT(Misses(kRounds, smooth, GreyTexel(0.02, 0.045, 0.7, 0.05, -0.05), of_substance,
                   same_roughness),
            0.02 * kRounds * kBatch);
}

}  // namespace
}  // namespace glint
