// Refinement by rows is refinement of the whole, wherever the sample is cut.
#include "fitting/refine/refine_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/resampling/resampling.h"

#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

constexpr int kSize = 20;

std::vector<float> RowsOf(const std::vector<float>& planes, int first, int rows) {
  std::vector<float> part;
  for (size_t plane = 0; plane < planes.size(); plane += kSize * kSize) {
    const auto begin = planes.begin() + static_cast<std::ptrdiff_t>(plane) + first * kSize;
    part.insert(part.end(), begin, begin + rows * kSize);
  }
  return part;
}

// A scene's rows, which it holds.
struct Part {
  Part(const test::SyntheticScene& scene, const RefineProblem& whole, const SvbrdfMaps& all,
       int first, int rows)
      : problem(whole), start(kSize, rows) {
    problem.plane = scene.plane.Rows(first, rows);
    start.planes = RowsOf(all.planes, first, rows);
    for (size_t v = 0; v < scene.views.size(); ++v) {
      rgb.push_back(RowsOf(scene.photographs[v], first, rows));
      mask.push_back(RowsOf(scene.masks[v], first, rows));
    }
    for (size_t v = 0; v < scene.views.size(); ++v) {
      problem.views[v].rgb = rgb[v];
      problem.views[v].mask = mask[v];
    }
  }
  RefineProblem problem;
  SvbrdfMaps start;
  std::vector<std::vector<float>> rgb, mask;
};

class RefineRowsTest : public ::testing::Test {
 protected:
  RefineRowsTest()
      : scene_(test::Photograph(test::QuarteredMaps(kSize, 3), 4)),
        start_(test::DisturbedMaps(scene_.truth, 0.5f, 4)) {
    options_.exposure_spread = 0.1;
    options_.light_spread = 0.02;
    std::fill_n(scene_.masks[1].begin(), 3 * kSize, 0.0f);  // a view that does not show all
  }

  RefineProblem Problem() const {
    RefineProblem problem = scene_.Problem();
    for (RefineView& view : problem.views) view.pixels_per_texel = pixels_per_texel_;
    return problem;
  }

  RefineResult ByRows(int at_once, int threads) const {
    const SampleEstimate estimate = EstimateSample(Problem(), start_, options_, threads);
    RowRefiner refiner(estimate, options_, Problem(), {0, kSize}, {}, threads, {});
    RefineResult result;
    result.maps = SvbrdfMaps(kSize, kSize);
    result.confidence.resize(kConfidencePlanes * start_.texels());
    for (int step = 0; step < refiner.steps(); ++step) {
      const int about = refiner.RowsAbout(step);
      for (int first = 0; first < kSize; first += at_once) {
        const int rows = std::min(at_once, kSize - first);
        const int above = std::min(first, about), below = std::min(kSize - first - rows, about);
        const Part part(scene_, Problem(), start_, first - above, above + rows + below);
        refiner.Take(part.problem, part.start, above, below);
        const auto refined = refiner.Do(step);
        if (!refined) continue;
        Put(refined->maps.planes, first, rows, &result.maps.planes);
        Put(refined->confidence, first, rows, &result.confidence);
      }
    }
    result.summary = Summarise(estimate, refiner.sums(), kSize);
    return result;
  }

  static void Put(const std::vector<float>& part, int first, int rows, std::vector<float>* all) {
    for (int p = 0; p * rows * kSize < static_cast<int>(part.size()); ++p) {
      std::copy_n(part.begin() + p * rows * kSize, rows * kSize,
                  all->begin() + p * kSize * kSize + first * kSize);
    }
  }

  test::SyntheticScene scene_;
  SvbrdfMaps start_;
  RefineOptions options_;
  double pixels_per_texel_ = 0;  // not known
};

TEST_F(RefineRowsTest, CutAnywhereTheResultIsTheSame) {
  const RefineResult whole = Refine(scene_.Problem(), start_, options_, 1);
  for (const auto& [at_once, threads] :
       {std::pair{kSize, 2}, std::pair{1, 1}, std::pair{3, 3}, std::pair{11, 2}}) {
    const RefineResult cut = ByRows(at_once, threads);
    EXPECT_EQ(cut.maps.planes, whole.maps.planes) << at_once;
    EXPECT_EQ(cut.confidence, whole.confidence) << at_once;
    EXPECT_EQ(cut.summary.final_cost, whole.summary.final_cost) << at_once;
    EXPECT_EQ(cut.summary.view_loss, whole.summary.view_loss) << at_once;
    EXPECT_EQ(cut.summary.neighbour, whole.summary.neighbour) << at_once;
  }
}

TEST_F(RefineRowsTest, ATexelDependsOnNoRowsFurtherAwayThanStated) {
  for (const int passes : {0, 1}) {
    options_.neighbour_passes = passes;
    const RefineResult whole = Refine(scene_.Problem(), start_, options_, 1);
    EXPECT_EQ(ByRows(4, 1).maps.planes, whole.maps.planes) << passes;
    EXPECT_EQ(ByRows(4, 1).confidence, whole.confidence) << passes;
  }
}

TEST_F(RefineRowsTest, CutAnywhereBlurredPhotographsGiveTheSame) {
  options_.neighbour_passes = 1;
  pixels_per_texel_ = 1;  // a blur over three texels
  const RefineResult whole = Refine(Problem(), start_, options_, 1);
  options_.point_spread_px = 0;
  EXPECT_NE(Refine(Problem(), start_, options_, 1).maps.planes, whole.maps.planes);
  options_.point_spread_px = 0.67;
  for (const auto& [at_once, threads] : {std::pair{3, 3}, std::pair{8, 2}}) {
    const RefineResult cut = ByRows(at_once, threads);
    EXPECT_EQ(cut.maps.planes, whole.maps.planes) << at_once;
    EXPECT_EQ(cut.confidence, whole.confidence) << at_once;
    EXPECT_EQ(cut.summary.view_loss, whole.summary.view_loss) << at_once;
  }
}

TEST_F(RefineRowsTest, ProgressEndsWithAllThatWasToBeDone) {
  for (const int passes : {0, 2}) {
    options_.neighbour_passes = passes;
    std::int64_t last = 0, all = -1;
    Refine(Problem(), start_, options_, 2, [&](std::int64_t done, std::int64_t total) {
      EXPECT_GT(done, last);
      last = done;
      all = total;
    });
    EXPECT_EQ(last, all) << passes;
  }
}

// A few of the texels say of the sample as a whole nearly what all say.
TEST_F(RefineRowsTest, EvenlySpacedTexelsStandForTheSample) {
  const RefineResult all = Refine(scene_.Problem(), start_, options_, 1);
  options_.estimation_size = 16;
  EXPECT_EQ(EstimationStride(scene_.plane, options_.estimation_size), 3);
  const RefineResult few = Refine(scene_.Problem(), start_, options_, 1);
  EXPECT_NE(few.maps.planes, all.maps.planes);
  EXPECT_NEAR(few.summary.residual_sigma, all.summary.residual_sigma,
              0.5 * all.summary.residual_sigma);
  for (size_t v = 0; v < scene_.views.size(); ++v) {
    EXPECT_NEAR(few.summary.exposures[v], all.summary.exposures[v], 0.05);
  }
}

// Taller than a tile of the relief, so that rows depend on some of the others alone.
class TallSampleTest : public ::testing::Test {
 protected:
  static constexpr int kWidth = 12, kHeight = 1500;
  TallSampleTest() : scene_(test::Photograph(Tall(), 3)) {
    options_.estimation_rounds = 2;
    estimate_.emplace(EstimateSample(scene_.Problem(), scene_.truth, options_, 2));
  }

  static SvbrdfMaps Tall() {
    SvbrdfMaps maps = test::LevelSubstance(kWidth, 0.4f), tall(kWidth, kHeight);
    for (int row = 0; row < kHeight; ++row) {
      const float slope = 0.1f * std::sin(0.3f * static_cast<float>(row));
      for (int p = 0; p < kSvbrdfPlanes; ++p) {
        for (int x = 0; x < kWidth; ++x) tall.at(p, row, x) = maps.at(p, row % kWidth, x);
      }
      for (int x = 0; x < kWidth; ++x) {
        tall.at(kNormalY, row, x) = slope;
        tall.at(kNormalZ, row, x) = std::sqrt(1 - slope * slope);
      }
    }
    return tall;
  }

  // `first`: of the rows solved by themselves.
  std::vector<float> MapsOf(RowSpan asked, int* first) const {
    RowRefiner refiner(*estimate_, options_, scene_.Problem(), asked, {}, 2, {});
    *first = refiner.RowsOf(0).first;
    std::optional<RowRefiner::Rows> rows;
    for (int step = 0; step < refiner.steps(); ++step) {
      const RowSpan of = refiner.RowsOf(step);
      const int about = refiner.RowsAbout(step);
      const int above = std::min(of.first, about), below = std::min(kHeight - of.last, about);
      const RowSpan read{of.first - above, of.last + below};
      RefineProblem part = scene_.Problem();
      part.plane = scene_.plane.Rows(read.first, read.size());
      std::vector<std::vector<float>> held;
      const auto cut = [&](std::span<const float> planes) {
        return CutRows(planes, kWidth, kHeight, read.first, read.size());
      };
      held.reserve(2 * part.views.size());
      for (RefineView& view : part.views) {
        view.rgb = held.emplace_back(cut(view.rgb));
        view.mask = held.emplace_back(cut(view.mask));
      }
      SvbrdfMaps start(kWidth, read.size());
      start.planes = cut(scene_.truth.planes);
      refiner.Take(part, start, above, below);
      rows = refiner.Do(step);
    }
    EXPECT_EQ(refiner.sums().size(), static_cast<size_t>(asked.size()));
    return rows->maps.planes;
  }

  test::SyntheticScene scene_;
  RefineOptions options_;
  std::optional<SampleEstimate> estimate_;
};

TEST_F(TallSampleTest, APartIsWhatTheWholeHasThere) {
  int first = 0;
  const std::vector<float> whole = MapsOf({0, kHeight}, &first);
  const RowSpan asked{1400, 1440};
  const std::vector<float> part = MapsOf(asked, &first);
  EXPECT_GT(first, 0);
  EXPECT_EQ(part, CutRows(whole, kWidth, kHeight, asked.first, asked.size()));
}

TEST(EstimationStride, IsOddAndLeavesAtMostTheSize) {
  SamplePlane plane;
  for (const auto& [side, stride] : {std::pair{1024, 1}, std::pair{1025, 3}, std::pair{3072, 3},
                                     std::pair{3073, 5}, std::pair{16384, 17}}) {
    plane.width = side;
    plane.height = 10;
    EXPECT_EQ(EstimationStride(plane, 1024), stride) << side;
  }
}

TEST(SamplePlane, TexelsOfAPartLieWhereTheyLieInTheWhole) {
  for (const TexelSampling sampling :
       {TexelSampling::kPixelCentres, TexelSampling::kCornerToCorner}) {
    const SamplePlane whole{30, 21, 120, 70, sampling};
    const SamplePlane rows = whole.Rows(5, 9), few = whole.Every(3);
    EXPECT_EQ(rows.x_mm(7), whole.x_mm(7));
    EXPECT_EQ(rows.y_mm(2), whole.y_mm(7));
    ASSERT_EQ(few.width, 10);
    ASSERT_EQ(few.height, 7);
    EXPECT_EQ(few.x_mm(9), whole.x_mm(28));
    EXPECT_EQ(few.y_mm(6), whole.y_mm(19));
  }
}

}  // namespace
}  // namespace glint
