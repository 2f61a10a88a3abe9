// What stages took on real machines against what the cost model says.
#include "base/programs/cost_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/programs/run_progress.h"

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

// Two cores of an EPYC with AVX-512 and bfloat16 and nothing else running, 26 November 2026;
// refinement of version 26, run.json of each stage. The report of version 10: what it takes longer
// than version 9, 0.052 µs per texel of every photograph (half of its processor-seconds, since two
// views are compared at once), is added to what that one took. Memory: 29 November 2026, refinement
// of version 41.
std::vector<MeasuredRun> Runs() {
  const auto size = [](int photographs, int side, double megapixels = 12) {
    return CaptureSize{photographs, kMega * megapixels, 1.0 * side * side, true};
  };
  return {
      {size(5, 256),
       {{"calib", 2.23, 307},
        {"rectify", 0.96, 239},
        {"fit", 8.82, 539},
        {"refine", 0.84, 181},
        {"export", 0.222, 161},
        {"report", 0.35, 197}}},
      {size(12, 512),
       {{"calib", 4.92, 358},
        {"rectify", 2.39, 263},
        {"fit", 9.55, 706},
        {"refine", 5.26, 351},
        {"export", 0.72, 211},
        {"report", 0.93, 256}}},
      {size(9, 1024),
       {{"calib", 4.52, 315},
        {"rectify", 2.38, 274},
        {"fit", 9.18, 678},
        {"refine", 5.24, 851},
        {"export", 1.78, 395},
        {"report", 1.91, 412}}},
      {size(9, 1024, 2),
       {{"calib", 1.92, 224},
        {"rectify", 1.47, 174},
        {"fit", 8.65, 698},
        {"refine", 5.67, 887},
        {"export", 1.76, 397},
        {"report", 1.82, 366}}},
      {size(12, 1024),
       {{"calib", 5.03, 348},
        {"rectify", 3.33, 281},
        {"fit", 10.4, 738},
        {"refine", 8.66, 967},
        {"export", 1.86, 395},
        {"report", 2.23, 407}}},
      {size(12, 2048),
       {{"calib", 5.05, 351},
        {"rectify", 8.95, 274},
        {"fit", 12.8, 756},
        {"refine", 24.2, 1159},
        {"export", 7.36, 913},
        {"report", 7.0, 739}}},
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
