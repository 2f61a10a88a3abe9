// What stages took on real machines against what the cost model says.
#include "pipeline/contract/cost_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pipeline/contract/run_progress.h"

namespace glint {
namespace {

struct Measured {
  const char* stage;
  double seconds, peak_memory_mb;
};

struct MeasuredRun {
  CaptureSize size;
  std::vector<Measured> stages;
};

constexpr double kMega = 1e6;

// Two cores of a Xeon with AVX-512 and bfloat16 and nothing else running, 24 November 2026; `glint
// run`, run.json of each stage. Refinement of version 21, all but the fourth: an EPYC with the
// same, 26 November.
std::vector<MeasuredRun> Runs() {
  const auto size = [](int photographs, double megapixels, int side) {
    return CaptureSize{photographs, kMega * megapixels, 1.0 * side * side, true};
  };
  return {
      {size(5, 12, 256),
       {{"calib", 2.53, 565},
        {"rectify", 1.29, 324},
        {"fit", 5.98, 359},
        {"refine", 4.51, 155},
        {"export", 0.694, 160},
        {"report", 1.21, 280}}},
      {size(12, 12, 512),
       {{"calib", 5.23, 570},
        {"rectify", 3.43, 323},
        {"fit", 7.62, 381},
        {"refine", 6.76, 294},
        {"export", 1.57, 208},
        {"report", 2.37, 317}}},
      {size(9, 2, 1024),
       {{"calib", 2.22, 236},
        {"rectify", 2.37, 230},
        {"fit", 8.84, 392},
        {"refine", 16.3, 517},
        {"export", 5.64, 391},
        {"report", 6.4, 398}}},
      {size(12, 12, 1024),
       {{"calib", 5.25, 570},
        {"rectify", 4.15, 384},
        {"fit", 8.79, 375},
        {"refine", 16.9, 566},
        {"export", 5.63, 392},
        {"report", 6.38, 408}}},
      {size(12, 12, 2048),
       {{"calib", 5.21, 570},
        {"rectify", 13.4, 404},
        {"fit", 12.6, 419},
        {"refine", 53.7, 1291},
        {"export", 23, 798},
        {"report", 15.9, 696}}},
  };
}

constexpr double kFactor = 1.5;

bool Within(double a, double b) { return std::max(a, b) <= kFactor * std::min(a, b); }

TEST(CostModel, MemoryOfEveryStageIsWithinOneAndAHalf) {
  for (const MeasuredRun& run : Runs()) {
    for (const Measured& stage : run.stages) {
      const double mb = PredictedMemory_bytes(stage.stage, run.size, 2) / kMega;
      EXPECT_TRUE(Within(mb, stage.peak_memory_mb))
          << stage.stage << " of " << run.size.texels << " texels: " << mb << " MB predicted, "
          << stage.peak_memory_mb << " MB measured";
    }
  }
}

TEST(CostModel, SecondsOfRunsAndOfEveryStageAreWithinOneAndAHalf) {
  for (const MeasuredRun& run : Runs()) {
    double predicted = 0, measured = 0;
    for (const Measured& stage : run.stages) {
      predicted += PredictedSeconds(stage.stage, run.size);
      measured += stage.seconds;
    }
    EXPECT_TRUE(Within(predicted, measured)) << predicted << " s, measured " << measured << " s";
    for (const Measured& stage : run.stages) {
      const double seconds = PredictedSeconds(stage.stage, run.size);
      EXPECT_TRUE(Within(seconds, stage.seconds))
          << stage.stage << " of " << run.size.texels << " texels: " << seconds << " s, measured "
          << stage.seconds << " s";
    }
  }
}

// A machine of half the speed makes no difference: what a run has taken so far shows it.
TEST(CostModel, TheTimeLeftIsWithinOneAndAHalfFromAFifthOfTheRunOn) {
  for (const MeasuredRun& run : Runs()) {
    for (const double slower : {1.0, 2.0}) {
      double all = 0, before = 0, predicted_before = 0, predicted_all = 0;
      for (const Measured& stage : run.stages) {
        all += slower * stage.seconds;
        predicted_all += PredictedSeconds(stage.stage, run.size);
      }
      for (const Measured& stage : run.stages) {
        const double own = PredictedSeconds(stage.stage, run.size);
        const RunProgress progress{0, predicted_before, own,
                                   predicted_all - predicted_before - own};
        for (const double share : {0.0, 0.3, 0.6, 0.9}) {
          const double now = before + slower * share * stage.seconds;
          const double left = all - now;
          if (now < 0.2 * all) continue;
          const auto said = progress.Remaining_s(share, now);
          ASSERT_TRUE(said.has_value());
          EXPECT_TRUE(Within(*said, left))
              << stage.stage << " " << share << " of " << run.size.texels << " texels: " << *said
              << " s said, " << left << " s left";
        }
        before += slower * stage.seconds;
        predicted_before += own;
      }
    }
  }
}

}  // namespace
}  // namespace glint
