#include "base/resampling/resampling.h"

#include <gtest/gtest.h>

#include <numeric>
#include <utility>
#include <vector>

namespace glint {
namespace {

// How much each input sample counts in all output samples together.
std::vector<double> Coverage(int input, const std::vector<Taps>& all) {
  std::vector<double> sum(input);
  for (const Taps& taps : all) {
    for (size_t k = 0; k < taps.weights.size(); ++k) sum[taps.first + k] += taps.weights[k];
  }
  return sum;
}

TEST(AreaTaps, CountEveryInputSampleTheSame) {
  for (const auto& [input, output] :
       {std::pair{8, 4}, std::pair{7, 3}, std::pair{101, 100}, std::pair{64, 1}, std::pair{5, 5}}) {
    const std::vector<Taps> all = AreaTaps(input, output);
    ASSERT_EQ(all.size(), static_cast<size_t>(output));
    for (const double covered : Coverage(input, all)) {
      EXPECT_NEAR(covered, static_cast<double>(output) / input, 1e-6) << input << " " << output;
    }
    for (const Taps& taps : all) {
      EXPECT_NEAR(std::accumulate(taps.weights.begin(), taps.weights.end(), 0.0), 1, 1e-6);
    }
  }
}

TEST(AreaOverlaps, SumToTheScaleAndTouchNoSampleBeyond) {
  for (int input = 1; input < 70; ++input) {
    for (int output = 1; output <= input; ++output) {
      for (const Overlaps& overlaps : AreaOverlaps(input, output)) {
        double sum = 0;
        for (const double share : overlaps.shares) {
          EXPECT_GT(share, 1e-9);
          sum += share;
        }
        EXPECT_NEAR(sum, static_cast<double>(input) / output, 1e-9);
        EXPECT_LE(overlaps.first + overlaps.shares.size(), static_cast<size_t>(input));
      }
    }
  }
}

TEST(TentTaps, KeepStraightLinesStraightWhenEnlarging) {
  for (const int output : {32, 33, 50, 128}) {
    const std::vector<Taps> all = TentTaps(32, output);
    for (int i = output / 16; i < output - output / 16; ++i) {
      double place = 0;
      for (size_t k = 0; k < all[i].weights.size(); ++k) {
        place += all[i].weights[k] * (all[i].first + static_cast<double>(k) + 0.5);
      }
      EXPECT_NEAR(place, (i + 0.5) * 32 / output, 1e-4) << output;
    }
  }
}

TEST(ResamplePlanes, AveragesEachPlaneAlongBothAxes) {
  // Two planes of 4 × 2; to 2 × 1.
  const std::vector<float> planes{1, 2, 3, 4, 5, 6, 7, 8, 10, 10, 20, 20, 30, 30, 40, 40};
  const std::vector<float> small = ResamplePlanes(planes, 4, 2, AreaTaps(4, 2), AreaTaps(2, 1));
  EXPECT_EQ(small, (std::vector<float>{3.5f, 5.5f, 20, 30}));
}

TEST(GroupTaps, HoldsEveryOutputOnceAndItsInputs) {
  for (const auto& taps : {AreaTaps(1000, 7), TentTaps(10, 333), TentTaps(100, 100)}) {
    size_t next = 0;
    for (const TapGroup& group : GroupTaps(taps, 50)) {
      EXPECT_EQ(group.first_output, static_cast<int>(next));
      EXPECT_TRUE(group.inputs <= 50 || group.taps.size() == 1);
      for (const Taps& own : group.taps) {
        EXPECT_EQ(own.first + group.first_input, taps[next].first);
        EXPECT_LE(own.first + static_cast<int>(own.weights.size()), group.inputs);
        EXPECT_EQ(own.weights, taps[next].weights);
        ++next;
      }
    }
    EXPECT_EQ(next, taps.size());
  }
}

TEST(Rows, CutAndPutBackAreTheBlocksTheyWere) {
  std::vector<float> planes(2 * 3 * 5);
  for (size_t i = 0; i < planes.size(); ++i) planes[i] = static_cast<float>(i);
  std::vector<float> copy(planes.size());
  for (const auto& [first, rows] : {std::pair{3, 2}, std::pair{0, 1}, std::pair{1, 2}}) {
    const std::vector<float> cut = CutRows(planes, 3, 5, first, rows);
    EXPECT_EQ(cut[static_cast<size_t>(3 * rows)], static_cast<float>(15 + 3 * first));
    PutRows(cut, 3, 5, first, copy);
  }
  EXPECT_EQ(copy, planes);
}

TEST(Rows, NoneArePutNowhere) {
  std::vector<float> planes(6, 1.0f);
  PutRows({}, 0, 3, 0, planes);
  EXPECT_EQ(planes, std::vector<float>(6, 1.0f));
}

TEST(PickEvery, TakesTheMiddleOfEveryStrideOfEveryBlock) {
  std::vector<float> planes(2 * 7 * 5);
  for (size_t i = 0; i < planes.size(); ++i) planes[i] = static_cast<float>(i);
  EXPECT_EQ(PickEvery(planes, 7, 5, 3), (std::vector<float>{8, 11, 29, 32, 43, 46, 64, 67}));
  EXPECT_EQ(PickEvery(planes, 7, 5, 1), planes);
}

TEST(SizeAtMost, KeepsTheProportionAndAtLeastOne) {
  EXPECT_EQ(SizeAtMost(300, 200, 300), std::pair(300, 200));
  EXPECT_EQ(SizeAtMost(300, 200, 150), std::pair(150, 100));
  EXPECT_EQ(SizeAtMost(1, 1000, 10), std::pair(1, 10));
}

}  // namespace
}  // namespace glint
