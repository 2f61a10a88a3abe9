// From photographs of drawn charts to colours.
#include "calib/chart/solve_chart.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "calib/chart/chart_picture.h"
#include "calib/chart/cielab.h"
#include "calib/chart/delta_e.h"
#include "calib/chart/read_chart.h"
#include "tests/calib/chart/chart_scene.h"
#include "tests/calib/chart/spectral_camera.h"

namespace glint {
namespace {

using testing::CameraFromRec709;
using testing::CameraMatrices;
using testing::ChartShot;
using testing::FlashWhites;
using testing::PhotographOf;

LinearPhoto LinearOf(const Photo& photo) {
  return {photo, photo.is_float() ? Encoding::kLinear : Encoding::kGamma22};
}

// As calib finds and solves it.
std::optional<ChartResult> Found(const Photo& photo, const std::string& kind, ColourModel model) {
  const auto corners = FindChart(photo, photo.is_float(), kind);
  if (!corners) return std::nullopt;
  const LinearPhoto linear = LinearOf(photo);
  return ChartReader(linear, Eigen::Vector3d::Ones(), model)
      .BestTurn({"photo", *ChartOfKind(kind), *corners, true, {}, {}, "chart", {}});
}

ChartSolution SolveAt(const Photo& photo, const Chart& chart, const ChartCorners& corners,
                      ColourModel model) {
  return SolveChart(chart, MeasureChart(LinearOf(photo), chart, corners), model);
}

void Print(const std::string& flash, const std::string& camera, const ChartSolution& solution) {
  std::printf("%-14s %-10s uncorrected %5.2f, fitted %.2f (%.2f), held out %.2f (%.2f), %zu\n",
              flash.c_str(), camera.c_str(), solution.UncorrectedMean(), solution.MeanDeltaE(),
              solution.WorstDeltaE(), solution.HeldOutMean(), solution.HeldOutWorst(),
              solution.patches.size());
}

double FarthestCorner(const ChartCorners& a, const ChartCorners& b) {
  double farthest = 0;
  for (size_t i = 0; i < 4; ++i) farthest = std::max(farthest, (a[i] - b[i]).norm());
  return farthest;
}

// The requirement: three flashes, three cameras, eight bits, noise, perspective, fall-off.
TEST(SolveChart, CorrectsHeldOutPatchesOfThreeCamerasUnderThreeFlashes) {
  const Chart chart = *ChartOfKind("classic24");
  for (const auto& [flash, white] : FlashWhites()) {
    for (const auto& [camera, matrix] : CameraMatrices()) {
      ChartShot shot;
      shot.camera = CameraFromRec709(matrix, white);
      const Photo photo = PhotographOf(chart, shot);
      const auto found = Found(photo, "classic24", ColourModel::kLinear);
      ASSERT_TRUE(found) << flash << ", " << camera;
      EXPECT_LT(FarthestCorner(found->corners_px, shot.corners_px), 20) << flash << ", " << camera;
      const ChartSolution& solution = found->solution;
      Print(flash, camera, solution);
      EXPECT_GE(solution.patches.size(), 22u);
      EXPECT_LE(solution.HeldOutMean(), 1.5) << flash << ", " << camera;
      EXPECT_LE(solution.HeldOutWorst(), 4) << flash << ", " << camera;
      EXPECT_GT(solution.UncorrectedMean(), 3) << flash << ", " << camera;
      // A white surface keeps its green value and loses its cast.
      const Eigen::Vector3d camera_white = shot.camera.rowwise().sum();
      const Eigen::Vector3d white_now = solution.correction(camera_white) / camera_white.y();
      EXPECT_LT((white_now.array() - 1).abs().maxCoeff(), 0.02) << white_now.transpose();
    }
  }
}

// Spectra, not matrices: no correction is exact.
TEST(SolveChart, CorrectsHeldOutPatchesOfCamerasThatSeeOtherThanTheEye) {
  Chart chart = *ChartOfKind("classic24");
  const auto reflectances = testing::SmoothReflectances(&chart);
  for (const std::string& flash : testing::SpectralFlashes()) {
    for (const std::string& camera : testing::SpectralCameras()) {
      const ChartSolution solution =
          SolveChart(chart, testing::SpectralReadings(chart, reflectances, flash, camera),
                     ColourModel::kLinear);
      Print(flash, camera, solution);
      EXPECT_LE(solution.HeldOutMean(), 1.5) << flash << ", " << camera;
      EXPECT_LE(solution.HeldOutWorst(), 4) << flash << ", " << camera;
    }
  }
  // The limit of three numbers a pixel: little blue light is left to tell blues apart by.
  const ChartSolution tungsten =
      SolveChart(chart, testing::SpectralReadings(chart, reflectances, "tungsten", "narrow"),
                 ColourModel::kLinear);
  Print("tungsten", "narrow", tungsten);
  EXPECT_LT(tungsten.HeldOutMean(), 3);
}

TEST(SolveChart, FindsTheLightThatLiesOnTheChart) {
  const Chart chart = *ChartOfKind("classic24");
  ChartShot shot;
  shot.bits = 32;
  shot.noise = 0;
  shot.flash = {-0.4, 0.3, 1.3};
  shot.camera = CameraFromRec709(CameraMatrices()[0].matrix, FlashWhites()[1].xyz);
  const ChartSolution solution =
      SolveAt(PhotographOf(chart, shot), chart, shot.corners_px, ColourModel::kLinear);
  EXPECT_LT(solution.WorstDeltaE(), 0.2);
  const double squared = shot.flash.squaredNorm();
  EXPECT_NEAR(solution.light.a, -2 * shot.flash.x() / squared, 0.02);
  EXPECT_NEAR(solution.light.b, -2 * shot.flash.y() / squared, 0.02);
  EXPECT_NEAR(solution.light.g, 1 / squared, 0.02);
  // A white surface in the middle, as stored.
  const Eigen::Vector3d white = shot.white * shot.camera.rowwise().sum();
  EXPECT_LT((solution.white_rgb - white).norm(), 0.01);
}

TEST(SolveChart, CorrectsByRootPolynomialsWhateverTheExposure) {
  const Chart chart = *ChartOfKind("sg140");
  ChartShot shot;
  shot.width = 1600;
  shot.height = 1200;
  shot.corners_px = {{{120, 110}, {1480, 130}, {1450, 1090}, {140, 1060}}};
  shot.camera = CameraFromRec709(CameraMatrices()[1].matrix, FlashWhites()[1].xyz);
  const ChartSolution solution =
      SolveAt(PhotographOf(chart, shot), chart, shot.corners_px, ColourModel::kRootPolynomial);
  EXPECT_LE(solution.HeldOutMean(), 1.5);
  EXPECT_LE(solution.HeldOutWorst(), 4);
  const Eigen::Vector3d rgb(0.3, 0.1, 0.2);
  EXPECT_LT((solution.correction(0.1 * rgb) - 0.1 * solution.correction(rgb)).norm(), 1e-12);
  const Eigen::Vector3d white = solution.correction(solution.white_rgb);
  EXPECT_LT((white.array() / solution.white_rgb.y() - 1).abs().maxCoeff(), 1e-6);
}

TEST(FindChart, FindsEveryKindItKnowsInPerspective) {
  for (const char* kind : {"classic24", "sg140", "vinyl18"}) {
    ChartShot shot;
    shot.width = 1600;
    shot.height = 1200;
    shot.corners_px = {{{170, 210}, {1400, 150}, {1450, 1010}, {150, 960}}};
    const auto found = Found(PhotographOf(*ChartOfKind(kind), shot), kind, ColourModel::kLinear);
    ASSERT_TRUE(found) << kind;
    EXPECT_LT(FarthestCorner(found->corners_px, shot.corners_px), 30) << kind;
    EXPECT_LT(found->solution.HeldOutMean(), 1.5) << kind;
  }
}

TEST(FindChart, FindsAChartInADarkLinearPhotograph) {
  ChartShot shot;
  shot.bits = 32;
  shot.white = 0.08;
  EXPECT_TRUE(
      Found(PhotographOf(*ChartOfKind("classic24"), shot), "classic24", ColourModel::kLinear));
}

TEST(FindChart, FindsTheSameInEveryRun) {
  ChartShot shot;
  const Photo photo = PhotographOf(*ChartOfKind("classic24"), shot);
  const auto first = FindChart(photo, photo.is_float(), "classic24");
  ASSERT_TRUE(first);
  for (int run = 0; run < 3; ++run)
    EXPECT_EQ(*FindChart(photo, photo.is_float(), "classic24"), *first);
}

TEST(FindChart, FindsNoneWhereThereIsNone) {
  ChartShot shot;
  Chart blank = *ChartOfKind("classic24");
  for (ChartPatch& patch : blank.patches) patch.lab = {20, 0, 0};
  EXPECT_FALSE(FindChart(PhotographOf(blank, shot), false, "classic24"));
}

TEST(MeasureChart, TellsWhatClipsAndWhatIsOutside) {
  const Chart chart = *ChartOfKind("classic24");
  ChartShot shot;
  shot.white = 2;
  ChartCorners corners = shot.corners_px;
  auto readings = MeasureChart(LinearOf(PhotographOf(chart, shot)), chart, corners);
  EXPECT_TRUE(readings[18].clipped);   // white
  EXPECT_FALSE(readings[23].clipped);  // black
  for (Eigen::Vector2d& corner : corners) corner.x() -= 300;
  readings = MeasureChart(LinearOf(PhotographOf(chart, shot)), chart, corners);
  EXPECT_FALSE(readings[0].inside);
  EXPECT_TRUE(readings[5].inside);
}

// Dust and a scratch: less than a quarter of a patch's pixels.
TEST(MeasureChart, LeavesOutWhatLiesOnAPatch) {
  const Chart chart = *ChartOfKind("classic24");
  ChartShot shot;
  shot.noise = 0;
  Photo photo = PhotographOf(chart, shot);
  const auto clean = MeasureChart(LinearOf(photo), chart, shot.corners_px);
  Image image = photo.image.Planes();
  for (int y = 0; y < shot.height; ++y) {
    for (int x = 0; x < shot.width; x += 8) {
      for (int c = 0; c < 3; ++c) image.channel(c)[static_cast<size_t>(y) * shot.width + x] = 1;
    }
  }
  photo.image = Stored(image, photo.bits);
  const auto dusty = MeasureChart(LinearOf(photo), chart, shot.corners_px);
  for (size_t i = 0; i < clean.size(); ++i) {
    if (clean[i].clipped) continue;  // cyan, which Rec.709 lacks
    EXPECT_LT((dusty[i].rgb - clean[i].rgb).norm(), 0.02 * clean[i].rgb.norm()) << i;
    EXPECT_FALSE(dusty[i].clipped) << i;
  }
}

TEST(SolveChart, SaysByHeldOutPatchesThatColoursAreAnothers) {
  const Chart chart = *ChartOfKind("classic24");
  ChartShot shot;
  Chart other = chart;
  for (size_t i = 0; i < 24; ++i) other.patches[i].lab = chart.patches[(7 * i + 5) % 24].lab;
  const ChartSolution solution =
      SolveAt(PhotographOf(other, shot), chart, shot.corners_px, ColourModel::kLinear);
  EXPECT_GT(solution.HeldOutMean(), 3);
  EXPECT_GT(solution.HeldOutMean(), solution.MeanDeltaE());
}

TEST(SolveGreyCard, BalancesWhiteAndLeavesHuesAlone) {
  const Chart card = GreyCard(0.18);
  PatchReading reading;
  reading.rgb = {0.15, 0.12, 0.06};
  reading.pixels = 100;
  const ChartSolution solution = SolveGreyCard(card, reading);
  EXPECT_LT((solution.correction(reading.rgb) - Eigen::Vector3d::Constant(0.12)).norm(), 1e-12);
  EXPECT_EQ(solution.correction({0, 0.5, 0}), Eigen::Vector3d(0, 0.5, 0));
  EXPECT_NEAR(solution.white_rgb.y(), 0.12 / 0.18, 1e-9);
  EXPECT_GT(solution.patches[0].uncorrected, 10);
}

TEST(ColourCorrection, TakesUpAGain) {
  ColourCorrection correction{ColourModel::kRootPolynomial, {}};
  correction.matrix << 1, 0.2, -0.1, 0.3, 0, 0.1, 0, 1, 0, 0.1, 0.1, 0, 0.1, 0, 0.9, 0, 0.2, 0.1;
  const Eigen::Vector3d rgb(0.4, 0.2, 0.5), gain(1.2, 1, 0.7);
  EXPECT_LT((correction.After(gain)(rgb) - correction(rgb.cwiseProduct(gain))).norm(), 1e-12);
}

TEST(ChartPicture, ShowsMeasuredColoursRoundTheReference) {
  const Chart chart = *ChartOfKind("classic24");
  ChartShot shot;
  const ChartSolution solution =
      SolveAt(PhotographOf(chart, shot), chart, shot.corners_px, ColourModel::kLinear);
  const Image picture = ChartPicture(chart, solution);
  EXPECT_EQ(picture.width, 720);
  const int x = static_cast<int>(720 * chart.patches[14].centre.x() / chart.size.x());  // red
  const int y = static_cast<int>(720 * chart.patches[14].centre.y() / chart.size.x());
  const size_t at = static_cast<size_t>(y) * 720 + x;
  EXPECT_GT(picture.channel(0)[at], 2 * picture.channel(1)[at]);
}

}  // namespace
}  // namespace glint
