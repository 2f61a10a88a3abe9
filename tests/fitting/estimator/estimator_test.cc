#include "fitting/estimator/estimator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "fitting/estimator/estimator_file.h"
#include "tests/fitting/initial_maps/synthetic_set.h"
#include "tests/support/process.h"
#include "tests/training/toy_materials.h"

namespace glint {
namespace {

using test::PhotographMaps;
using test::UniformMaps;

// A network of drawn weights, as a file: of each kind that there is.
class EstimatorFile : public testing::TestWithParam<EstimatorKind> {
 protected:
  void SetUp() override {
    EstimatorNetwork network =
        EstimatorNetwork::Random({{8, 12, 16, 16, 24}, 8, 16}, 3, GetParam());
    SaveEstimator(path_, &network, {});
  }
  SvbrdfMaps Estimate(const PhotographSet& set, int threads = 1) const {
    return Estimator::Load(path_).Estimate(set, {}, threads).maps;
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "e.safetensors";
};

TEST_P(EstimatorFile, BitsDoNotDependOnThreads) {
  const PhotographSet set = PhotographMaps(ToyMaterial(2, 70, 45), 1);
  EXPECT_EQ(Estimate(set, 1).planes, Estimate(set, 2).planes);
}

TEST_P(EstimatorFile, MapsAreOfThePhotographsSizeAndWithinTheirRanges) {
  for (const auto& [width, height] : {std::pair{1, 1}, {33, 20}, {64, 96}}) {
    const PhotographSet set = PhotographMaps(ToyMaterial(2, width, height), 1);
    const SvbrdfMaps maps = Estimate(set);
    ASSERT_EQ(maps.width, width);
    ASSERT_EQ(maps.height, height);
    for (const float r : maps.plane(kRoughness)) EXPECT_TRUE(r > 0 && r <= 1);
    for (const float z : maps.plane(kNormalZ)) EXPECT_GT(z, 0);
  }
}

TEST_P(EstimatorFile, BeforeTrainingDiffuseIsAboutWhatAMatteTexelShows) {
  const PhotographSet set = PhotographMaps(UniformMaps(64, 0.3f, 0.0f, 1.0f), 1);
  const SvbrdfMaps maps = Estimate(set);
  EXPECT_NEAR(maps.at(kDiffuseR, 20, 20), 0.3f, 0.15f);
}

TEST_P(EstimatorFile, TheOrderOfPhotographsDoesNotMatter) {
  PhotographSet set = PhotographMaps(ToyMaterial(2, 64, 64), 4);
  const SvbrdfMaps before = Estimate(set);
  std::reverse(set.photographs.begin(), set.photographs.end());
  const SvbrdfMaps after = Estimate(set);
  for (size_t i = 0; i < before.planes.size(); ++i) {
    ASSERT_NEAR(before.planes[i], after.planes[i], 1e-4f);
  }
}

TEST_P(EstimatorFile, APhotographGivenTwiceSaysNoMoreThanOnce) {
  PhotographSet set = PhotographMaps(ToyMaterial(2, 64, 64), 1);
  const SvbrdfMaps once = Estimate(set);
  set.photographs.push_back(set.photographs[0]);
  const SvbrdfMaps twice = Estimate(set);
  for (size_t i = 0; i < once.planes.size(); ++i) {
    ASSERT_NEAR(once.planes[i], twice.planes[i], 1e-4f);
  }
}

TEST_P(EstimatorFile, APhotographWhoseFrameEndsAtATexelDoesNotDarkenIt) {
  PhotographSet set = PhotographMaps(UniformMaps(64, 0.3f, 0.0f, 1.0f), 2);
  for (int i = 0; i < 64 * 32; ++i) {
    set.photographs[1].mask[i] = 0;
    for (int c = 0; c < 3; ++c) set.photographs[1].rgb[c * 4096 + i] = 0;
  }
  EXPECT_NEAR(Estimate(set).at(kDiffuseR, 10, 20), 0.3f, 0.15f);
}

TEST_P(EstimatorFile, DamagedFilesAreRefusedWithTheirName) {
  const std::string bytes = test::ReadAll(path_);
  for (const double share : {0.0, 0.01, 0.5, 0.99}) {
    test::WriteAll(path_,
                   bytes.substr(0, static_cast<size_t>(share * static_cast<double>(bytes.size()))));
    try {
      Estimator::Load(path_);
      ADD_FAILURE() << share;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("e.safetensors"));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EstimatorFile,
                         testing::Values(EstimatorKind::kPooled, EstimatorKind::kAttended,
                                         EstimatorKind::kDescent),
                         [](const auto& kind) { return EstimatorKindName(kind.param); });

TEST(EstimatorKinds, AreNamedInTheFileAndOthersAreRefused) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "e.safetensors";
  EstimatorNetwork network =
      EstimatorNetwork::Random({{8, 12, 16, 16, 24}, 8, 16}, 3, EstimatorKind::kDescent);
  SaveEstimator(path, &network, {});
  EXPECT_EQ(LoadEstimator(path).kind, EstimatorKind::kDescent);
  SaveEstimator(path, &network, {{"architecture", "glint-estimator v3 clairvoyant"}});
  try {
    LoadEstimator(path);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("\"glint-estimator v3 clairvoyant\""));
  }
}

}  // namespace
}  // namespace glint
