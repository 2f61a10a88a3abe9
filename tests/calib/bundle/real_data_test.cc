// Published calibrations of real pictures, reproduced; the tables are printed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/bundle/bundle.h"
#include "calib/validation/cross_validation.h"
#include "calib/validation/diagnosis.h"
#include "tests/calib/testing/real_sets.h"
#include "tests/support/data_folder.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

struct Published {
  std::string name;
  double value, sigma;
};

// One line per parameter; true when all differences are within `limit` standard deviations, both
// uncertainties taken together.
bool PrintTable(const std::string& title, const BundleResult& result,
                const std::vector<Published>& published, double limit) {
  fmt::print("\n{}: {} of {} corners, {:.3f} px RMS\n", title, result.inliers, result.corners,
             result.rms_px);
  fmt::print("  {:<4} {:>12} {:>10} {:>12} {:>10} {:>11} {:>6}\n", "", "published", "±", "Glint",
             "±", "difference", "in σ");
  const CameraEstimate& estimate = result.cameras[0];
  const auto& names = CameraParameterNames(estimate.camera.model);
  bool agree = true;
  for (const Published& p : published) {
    const size_t i = std::find(names.begin(), names.end(), p.name) - names.begin();
    const double difference = estimate.camera.parameters[i] - p.value;
    const double sigma = std::hypot(p.sigma, estimate.sigma[i]);
    fmt::print("  {:<4} {:>12.5g} {:>10.3g} {:>12.5g} {:>10.3g} {:>11.3g} {:>6.2f}\n", p.name,
               p.value, p.sigma, estimate.camera.parameters[i], estimate.sigma[i], difference,
               difference / sigma);
    agree = agree && std::abs(difference) <= limit * sigma;
  }
  return agree;
}

// Z. Zhang, "A flexible new technique for camera calibration", table 1: five images. Zhang's own
// corners, so that only the estimation is compared.
TEST(RealData, ZhangsResultIsReproduced) {
  const fs::path folder = test::DataFolder() / "calib/zhang1998";
  if (!fs::exists(folder)) GTEST_SKIP() << "no real data";
  const BundleProblem problem = testing::ZhangProblem(folder);
  ASSERT_EQ(problem.photos[4].corners.size(), 256u);
  BundleOptions options;
  options.hold = {"p1", "p2"};
  options.reject = false;  // as published
  const BundleResult result = AdjustBundle(problem, options);
  EXPECT_TRUE(PrintTable("Zhang 1998", result,
                         {{"fx", 832.5, 1.41},
                          {"fy", 832.53, 1.38},
                          {"cx", 303.959 + 0.5, 0.71},
                          {"cy", 206.585 + 0.5, 0.66},
                          {"k1", -0.228601, 0.003},
                          {"k2", 0.190353, 0.025}},
                         1));
  EXPECT_NEAR(result.rms_px, 0.3364, 0.003);
}

constexpr double kPublishedRms_px = 0.39259;

// OpenCV samples/data/left_intrinsics.yml. It states no uncertainties; those put beside its values
// are ours for the same views with its residual.
std::vector<Published> LeftIntrinsics(const BundleResult& result) {
  std::vector<Published> published = {
      {"fx", 535.91573, 0},       {"fy", 535.91573, 0},    {"cx", 342.28315 + 0.5, 0},
      {"cy", 235.57083 + 0.5, 0}, {"k1", -0.26637261, 0},  {"k2", -0.038588899, 0},
      {"p1", 0.0017831947, 0},    {"p2", -0.000281221, 0}, {"k3", 0.23839153, 0}};
  const auto& names = CameraParameterNames(result.cameras[0].camera.model);
  for (Published& p : published) {
    const size_t at = std::find(names.begin(), names.end(), p.name) - names.begin();
    p.sigma = result.cameras[0].sigma[at] * kPublishedRms_px / result.rms_px;
  }
  return published;
}

class LeftCamera : public ::testing::Test {
 protected:
  // The board is looked for once a process: that takes seconds.
  const BundleProblem& Problem(const std::string& side) {
    static std::map<std::string, BundleProblem> problems;
    auto& problem = problems[side];
    if (problem.photos.empty()) problem = testing::ChessboardProblem(folder_, side);
    return problem;
  }
  void SetUp() override {
    if (!fs::exists(folder_)) GTEST_SKIP() << "no real data";
  }
  fs::path folder_ = test::DataFolder() / "calib/opencv_left_right";
  BundleOptions options_ = testing::FiveTermOptions();
};

// The corners as the publication has them: findChessboardCorners, cornerSubPix 11×11.
std::vector<BundleCorner> OpenCvCorners(const fs::path& file) {
  const cv::Mat picture = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  std::vector<cv::Point2f> points;
  EXPECT_TRUE(cv::findChessboardCorners(picture, {9, 6}, points)) << file;
  cv::cornerSubPix(picture, points, {11, 11}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 0.01});
  std::vector<BundleCorner> corners;
  for (int k = 0; k < static_cast<int>(points.size()); ++k) {
    corners.push_back(
        {k, {25.0 * (k % 9), -25.0 * (k / 9)}, {points[k].x + 0.5, points[k].y + 0.5}});
  }
  return corners;
}

TEST_F(LeftCamera, TheEstimationAgreesWithThePublishedIntrinsics) {
  BundleProblem problem = Problem("left");
  for (BundlePhoto& photo : problem.photos) photo.corners = OpenCvCorners(folder_ / photo.name);
  options_.reject = false;  // as published
  const BundleResult result = AdjustBundle(problem, options_);
  EXPECT_TRUE(PrintTable("OpenCV left, OpenCV's corners", result, LeftIntrinsics(result), 0.5));
  EXPECT_NEAR(result.rms_px, kPublishedRms_px, 0.03);
}

// Our own corners leave less than half of the published residual; the intrinsics move by what the
// published corners' errors explain.
TEST_F(LeftCamera, OurCornersAgreeAndFitBetter) {
  const BundleProblem& problem = Problem("left");
  for (const BundlePhoto& photo : problem.photos) EXPECT_GE(photo.corners.size(), 50u);
  const BundleResult result = AdjustBundle(problem, options_);
  EXPECT_TRUE(PrintTable("OpenCV left, our corners", result, LeftIntrinsics(result), 3));
  EXPECT_LT(result.rms_px, 0.5 * kPublishedRms_px);
}

// Odd against even photographs differ by no more than twice what the covariances predict. Zhang's
// five images are too few for it.
TEST_F(LeftCamera, OddAndEvenPhotographsAgree) {
  for (const std::string side : {"left", "right"}) {
    const BundleProblem& problem = Problem(side);
    for (const bool bend : {false, true}) {
      BundleOptions options;
      options.bend = bend;
      const BundleResult result = AdjustBundle(problem, options);
      const CrossValidation validation = CrossValidate(problem, options, result);
      ASSERT_EQ(validation.problem, "");
      const Diagnosis diagnosis = Diagnose(problem, options, result);
      fmt::print(
          "{} {}: {:.3f} px RMS, held out {:.3f}; difference {:.3f} px, predicted {:.3f}, "
          "ratio {:.2f}\n{}\n",
          side, bend ? "bent" : "flat", result.rms_px, validation.held_out_rms_px,
          validation.cameras[0].rms_px, validation.cameras[0].predicted_px, validation.ratio(),
          fmt::join(diagnosis.words, "\n"));
      EXPECT_LE(validation.ratio(), kTrustedRatio);
    }
  }
}

}  // namespace
}  // namespace glint
