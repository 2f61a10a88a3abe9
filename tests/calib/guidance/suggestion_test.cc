#include "calib/guidance/suggestion.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "calib/guidance/expected_error.h"
#include "tests/calib/guidance/photo_fixture.h"

namespace glint {
namespace {

using testing::PhotoFrom;

constexpr double kHighlight_deg = 8;

// The promise that advice makes is kept by the photograph that follows it.
TEST(Suggestion, TheSuggestedPhotographsBringWhatTheyPromise) {
  const std::vector<std::vector<GuidancePhoto>> captures = {
      {PhotoFrom(300, 35, 100)},
      {PhotoFrom(250, 0, 0), PhotoFrom(300, 30, 10)},
      {PhotoFrom(300, 12, 180), PhotoFrom(300, 12, 170), PhotoFrom(300, 25, 190)}};
  for (const std::vector<GuidancePhoto>& photos : captures) {
    const CoverageGrid grid = MakeCoverageGrid({100, 100});
    const Coverage before = ComputeCoverage(grid, photos);
    const auto suggestions = SuggestForHighlights(before, photos, kHighlight_deg);
    ASSERT_FALSE(suggestions.empty());
    std::vector<GuidancePhoto> then = photos;
    double promised = before.HighlightShare(kHighlight_deg);
    for (const Suggestion& one : suggestions) {
      then.push_back(one.photo);
      promised += one.gain_share;
      EXPECT_NEAR(ComputeCoverage(grid, then).HighlightShare(kHighlight_deg), promised, 1e-9);
    }
    EXPECT_GT(promised, 0.8);
    for (size_t i = 1; i < suggestions.size(); ++i) {
      EXPECT_LE(suggestions[i].gain_share, suggestions[i - 1].gain_share);
    }
  }
}

// A highlight falls below the phone: for the right edge it must stand on the right.
TEST(Suggestion, GoesToTheSideThatIsDark) {
  for (const double azimuth : {0.0, 90.0, 225.0}) {
    std::vector<GuidancePhoto> photos = {PhotoFrom(300, 8, azimuth + 180)};
    const Coverage coverage = ComputeCoverage(MakeCoverageGrid({100, 100}), photos);
    const auto suggestions = SuggestForHighlights(coverage, photos, kHighlight_deg);
    ASSERT_FALSE(suggestions.empty());
    const double off = std::remainder(suggestions[0].direction.azimuth_deg - azimuth, 360);
    EXPECT_LT(std::abs(off), 46) << azimuth;
    EXPECT_LT(suggestions[0].direction.tilt_deg, 20);
  }
}

TEST(Suggestion, IsNoneWhereAllIsSeen) {
  const GuidanceInput good = testing::GoodCapture();
  const Coverage coverage = ComputeCoverage(MakeCoverageGrid({100, 100}), good.photos);
  EXPECT_GT(coverage.HighlightShare(kHighlight_deg), 0.97);
  EXPECT_TRUE(SuggestForHighlights(coverage, good.photos, kHighlight_deg, 3, 0.03).empty());
}

TEST(Gap, IsTheLargestBetweenNeighboursRoundTheCircle) {
  const auto gap = LargestGap({PhotoFrom(300, 30, 350), PhotoFrom(300, 30, 100),
                               PhotoFrom(300, 30, 200), PhotoFrom(300, 3, 280)},
                              15);
  EXPECT_NEAR(gap.width_deg, 150, 1e-6);
  EXPECT_NEAR(gap.middle_deg, 275, 1e-6);
  EXPECT_NEAR(LargestGap({PhotoFrom(300, 30, 90)}, 15).width_deg, 360, 1e-6);
  EXPECT_NEAR(LargestGap({PhotoFrom(300, 30, 90)}, 15).middle_deg, 270, 1e-6);
  EXPECT_EQ(LargestGap({PhotoFrom(300, 3, 90)}, 15).width_deg, 360);
}

TEST(Words, NameSidesAsTheMapsShowThem) {
  EXPECT_EQ(SideName(0), "right");
  EXPECT_EQ(SideName(338), "right");
  EXPECT_EQ(SideName(90), "top");
  EXPECT_EQ(SideName(135), "top left");
  EXPECT_EQ(SideName(270), "bottom");
  EXPECT_EQ(InWords({0, 40}), "from directly above");
  EXPECT_EQ(InWords({12.5, 180}), "12° off vertical toward the left");
}

TEST(Words, NameTheRegionThatIsMarked) {
  const CoverageGrid grid = MakeCoverageGrid({100, 100}, 20);
  const auto region = [&](auto marked) {
    std::vector<bool> cells;
    for (size_t i = 0; i < grid.cells(); ++i) cells.push_back(marked(grid.Centre_mm(i)));
    return RegionName(grid, cells);
  };
  using P = Eigen::Vector2d;
  EXPECT_EQ(region([](const P& p) { return p.x() > 30; }), "the right edge");
  EXPECT_EQ(region([](const P& p) { return p.y() < -30; }), "the bottom edge");
  EXPECT_EQ(region([](const P& p) { return p.x() < -20 && p.y() > 20; }), "the top left corner");
  EXPECT_EQ(region([](const P& p) { return p.norm() > 45; }), "the rim");
  EXPECT_EQ(region([](const P& p) { return p.norm() < 20; }), "the middle");
  EXPECT_EQ(region([](const P& p) { return p.x() > -40; }), "most of it");
  EXPECT_EQ(region([](const P&) { return true; }), "all of it");
}

// The rows "refined" of the procedural materials, five digits of each figure.
TEST(ExpectedError, IsThatOfTheTable) {
  std::ifstream file(std::string(GLINT_SOURCE_DIR) + "/docs/results/table1.md");
  std::string line;
  while (std::getline(file, line) && line.rfind("The sixteen procedural ones", 0) != 0) {
  }
  int rows = 0;
  while (std::getline(file, line)) {
    int photos;
    double diffuse, specular, roughness, normal, maps, render;
    if (std::sscanf(line.c_str(), "| %d | refined | %lf | %lf | %lf | %lf | %lf | %lf |", &photos,
                    &diffuse, &specular, &roughness, &normal, &maps, &render) != 7) {
      continue;
    }
    ++rows;
    EXPECT_NEAR(ErrorForPhotos(photos).maps, maps, 5.1e-6) << photos;
    EXPECT_NEAR(ErrorForPhotos(photos).render, render, 5.1e-6) << photos;
  }
  EXPECT_EQ(rows, 4);
}

TEST(ExpectedError, FallsBetweenTheTablesRows) {
  EXPECT_EQ(ErrorForPhotos(50).maps, ErrorForPhotos(20).maps);
  for (int n = 1; n < 20; ++n) {
    EXPECT_LT(ErrorForPhotos(n + 1).render, ErrorForPhotos(n).render);
    EXPECT_LT(ErrorForPhotos(n + 1).maps, ErrorForPhotos(n).maps);
  }
}

}  // namespace
}  // namespace glint
