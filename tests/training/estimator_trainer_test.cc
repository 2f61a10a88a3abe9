#include "training/estimator_trainer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/process.h"
#include "tests/training/toy_materials.h"

namespace glint {
namespace {

EstimatorTrainOptions TinyEstimator(std::int64_t steps) {
  auto options = TinyTraining<EstimatorTrainOptions>(steps);
  options.channels = {8, 12, 16, 16, 24, 8, 16};
  return options;
}

TEST(EstimatorTrainer, AShortTrainingTakesAThirdOffTheErrorOnUnseenMaterials) {
  const test::TemporaryFolder folder;
  double first = 0;
  const TrainProgress last =
      TrainEstimator(TinyEstimator(150), {folder.path() / "e.safetensors", {}, {}, false}, Toy,
                     Unseen, [&](const TrainProgress& p) {
                       if (p.step == 0) first = *p.validation_map_loss;
                     });
  ASSERT_TRUE(last.validation_map_loss.has_value());
  EXPECT_LT(*last.validation_map_loss, 0.67 * first);
}

TEST(EstimatorTrainer, AResumedTrainingEndsWithTheSameBits) {
  const test::TemporaryFolder folder;
  const auto train = [&](const char* name, std::int64_t stop, bool resume) {
    EstimatorTrainOptions options = TinyEstimator(6);
    options.checkpoint_minutes = 1e-9;  // after every step
    const auto report = [&](const TrainProgress& p) {
      if (stop > 0 && p.step == stop) throw std::runtime_error("interrupted");
    };
    try {
      TrainEstimator(options, {folder.path() / name, {}, {}, resume}, Toy, Unseen, report);
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "interrupted");
    }
  };
  train("whole.safetensors", 0, false);
  train("parts.safetensors", 3, false);
  train("parts.safetensors", 0, true);
  EXPECT_EQ(test::ReadAll(folder.path() / "whole.safetensors"),
            test::ReadAll(folder.path() / "parts.safetensors"));
}

TEST(EstimatorTrainer, ATrainingFromWeightsBeginsWhereTheyWere) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "e.safetensors";
  const TrainProgress trained =
      TrainEstimator(TinyEstimator(100), {path, {}, {}, false}, Toy, Unseen, {});
  EstimatorTrainOptions options = TinyEstimator(1);
  options.from = path;
  options.channels.back() += 8;  // the file's count
  double first = 0;
  TrainEstimator(options, {folder.path() / "on.safetensors", {}, {}, false}, Toy, Unseen,
                 [&](const TrainProgress& p) {
                   if (p.step == 0) first = *p.validation_map_loss;
                 });
  EXPECT_NEAR(first, *trained.validation_map_loss, 0.01 * first);  // weights are kept in bf16
}

// The weights are spoilt after the first third; without help all outputs would stay at the ends of
// their ranges.
TEST(EstimatorTrainer, ASupervisedTrainingReturnsFromAJumpOfItsLossWithHalfTheRate) {
  const test::TemporaryFolder folder;
  EstimatorTrainOptions options = TinyEstimator(240);
  options.supervise = true;
  options.test_jump_step = 80;
  options.report_seconds = 0.05;
  double first = 0, rate_before = 0;
  int returns = 0;
  const auto report = [&](const TrainProgress& p) {
    if (p.step == 0) first = *p.validation_map_loss;
    if (returns == 0) rate_before = p.learning_rate;
    if (!p.event.empty()) {
      ++returns;
      EXPECT_LT(p.step, 110);
    }
  };
  const TrainProgress last = TrainEstimator(
      options, {folder.path() / "e.safetensors", {}, {}, false}, Toy, Unseen, report);
  EXPECT_GE(returns, 1);
  EXPECT_EQ(last.step, 240);
  EXPECT_LT(last.learning_rate, 0.5 * rate_before);
  EXPECT_LT(*last.validation_map_loss, 0.8 * first);
}

TEST(EstimatorTrainer, ADescentBeginsWherePooledWeightsWereAndNoOtherNetworkDoes) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "e.safetensors";
  const TrainProgress trained =
      TrainEstimator(TinyEstimator(60), {path, {}, {}, false}, Toy, Unseen, {});
  EstimatorTrainOptions options = TinyEstimator(2);
  options.from = path;
  options.network = "descent";
  double first = 0;
  TrainEstimator(options, {folder.path() / "on.safetensors", {}, {}, false}, Toy, Unseen,
                 [&](const TrainProgress& p) {
                   if (p.step == 0) first = *p.validation_map_loss;
                 });
  EXPECT_NEAR(first, *trained.validation_map_loss, 0.01 * first);
  options.network = "attended";
  EXPECT_THROW(
      TrainEstimator(options, {folder.path() / "no.safetensors", {}, {}, false}, Toy, Unseen, {}),
      std::runtime_error);
}

TEST(EstimatorTrainer, ACheckpointOfOtherChannelsIsRefused) {
  const test::TemporaryFolder folder;
  const TrainFiles files{folder.path() / "e.safetensors", {}, {}, true};
  TrainEstimator(TinyEstimator(1), files, Toy, Unseen, {});
  EstimatorTrainOptions other = TinyEstimator(2);
  other.channels[0] = 10;
  try {
    TrainEstimator(other, files, Toy, Unseen, {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("channels"),
                                             testing::HasSubstr("8,12,16,16,24,8,16")));
  }
}

}  // namespace
}  // namespace glint
