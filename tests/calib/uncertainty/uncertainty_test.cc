#include <gtest/gtest.h>

#include <cmath>

#include "calib/uncertainty/implied_motion.h"
#include "calib/uncertainty/projection_jacobian.h"
#include "calib/uncertainty/projection_uncertainty.h"
#include "calib/uncertainty/sample_uncertainty.h"
#include "calib/uncertainty/uncertainty_picture.h"
#include "tests/calib/testing/board_scene.h"

namespace glint {
namespace {

using testing::MakeScene;
using testing::PhoneCamera;

BundleResult Calibrated(const testing::SceneSettings& settings) {
  BundleOptions options;
  options.model = CameraModel::kRadial;
  return AdjustBundle(MakeScene(PhoneCamera(CameraModel::kRadial), settings).problem, options);
}

// Moving the principal point is nearly turning the camera: what is left after the implied motion is
// small, and the turn is the one that trigonometry gives.
TEST(ImpliedMotion, ShiftedPrincipalPointIsATurn) {
  const BundleResult result = Calibrated({});
  const Camera& from = result.cameras[0].camera;
  Camera to = from;
  to.parameters[1] += 2;
  const auto points = SeenPoints(result, 0);
  ASSERT_GT(points.size(), 500u);
  const Rigid3 motion = AlignCameras(from, to, points);
  EXPECT_NEAR(std::abs(Eigen::AngleAxisd(motion.rotation).angle()), 2.0 / 3100, 4e-4);
  double squares = 0;
  for (const auto& point : points) {
    squares += (ImageFromCamera(to, motion * point) - ImageFromCamera(from, point)).squaredNorm();
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(points.size())), 0.2);
}

// The derivative of the motion against the motion itself.
TEST(ImpliedMotion, IsTheDerivativeOfTheAlignment) {
  const BundleResult result = Calibrated({});
  const Camera& from = result.cameras[0].camera;
  const auto points = SeenPoints(result, 0);
  const Eigen::MatrixXd linear = ImpliedMotion(from, points);
  const double steps[] = {0.5, 0.5, 0.5, 1e-4, 1e-4};
  for (int i = 0; i < 5; ++i) {
    Camera to = from;
    to.parameters[i] += steps[i];
    const Rigid3 motion = AlignCameras(from, to, points);
    const Eigen::AngleAxisd turn(motion.rotation);
    Eigen::Matrix<double, 6, 1> found;
    found << turn.angle() * turn.axis(), motion.translation;
    const Eigen::Matrix<double, 6, 1> expected = linear.col(i) * steps[i];
    EXPECT_LT((found - expected).norm(), 0.01 * expected.norm() + 1e-9) << i;
  }
}

// Corners on the left half alone: the projection is well known there, and ever less to the right.
TEST(ProjectionUncertainty, GrowsWhereNothingWasSeen) {
  testing::Scene scene = MakeScene(PhoneCamera(CameraModel::kRadial), {});
  for (BundlePhoto& photo : scene.problem.photos) {
    std::erase_if(photo.corners, [](const BundleCorner& c) { return c.point_px.x() > 2000; });
  }
  BundleOptions options;
  options.model = CameraModel::kRadial;
  const BundleResult result = AdjustBundle(scene.problem, options);
  const ProjectionUncertainty uncertainty(result.cameras[0], SeenPoints(result, 0));
  const double depth_mm = uncertainty.median_depth_mm();
  const double left = WorstSigma(*uncertainty.At({1200, 1500}, depth_mm));
  const double right = WorstSigma(*uncertainty.At({3800, 1500}, depth_mm));
  EXPECT_GT(left, 0);
  EXPECT_LT(left, 0.1);
  EXPECT_GT(right, 5 * left);
}

TEST(ProjectionUncertainty, IsProportionalToTheNoise) {
  testing::SceneSettings one, four;
  four.noise_px = 4 * one.noise_px;
  const UncertaintyMap a = MapUncertainty(Calibrated(one), 0);
  const BundleResult noisy = Calibrated(four);
  const UncertaintyMap b = MapUncertainty(noisy, 0);
  ASSERT_EQ(a.sigma_px.size(), b.sigma_px.size());
  EXPECT_NEAR(b.median_px / a.median_px, 4, 0.3);
  EXPECT_NEAR(b.centre_px / a.centre_px, 4, 0.3);
  EXPECT_LE(a.centre_px, a.largest_px);
  const Image picture = UncertaintyPicture(noisy, 0, b);
  EXPECT_EQ(picture.width, 1000);
  EXPECT_GT(picture.height, 750);
}

// With known intrinsics only the pose is uncertain; solving for them as well adds to that.
TEST(SampleUncertainty, IsLargerWithFreeIntrinsics) {
  testing::Scene scene = MakeScene(PhoneCamera(CameraModel::kRadial), {});
  BundleOptions options;
  options.model = CameraModel::kRadial;
  const BundleResult free = AdjustBundle(scene.problem, options);
  scene.problem.cameras[0].known = free.cameras[0].camera;
  const BundleResult fixed = AdjustBundle(scene.problem, options);
  for (size_t i = 0; i < free.photos.size(); ++i) {
    const double with_free = UncertaintyAtSample(free, i, {80, 80}).sigma_mm;
    const double with_fixed = UncertaintyAtSample(fixed, i, {80, 80}).sigma_mm;
    EXPECT_GT(with_fixed, 0);
    EXPECT_GT(with_free, with_fixed);
    EXPECT_LT(with_free, 0.02);
  }
}

}  // namespace
}  // namespace glint
