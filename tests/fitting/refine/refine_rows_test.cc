// Refinement by rows is refinement of the whole, wherever the sample is cut.
#include "fitting/refine/refine_rows.h"

#include <gtest/gtest.h>

#include <algorithm>

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
