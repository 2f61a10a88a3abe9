#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/camera/similarity3.h"
#include "base/errors/errors.h"
#include "calib/colmap/colmap_camera.h"

namespace glint {
namespace {

using ::testing::HasSubstr;

// A phone's lens by each of COLMAP's models: about 67° across.
ColmapCamera Lens(const std::string& name) {
  const std::vector<double> one{3000, 2010, 1490}, two{3000, 3010, 2010, 1490};
  std::vector<double> parameters =
      ColmapModels()[*ColmapModelFromName(name)].focal_lengths == 1 ? one : two;
  std::vector<double> extra;
  if (name == "SIMPLE_RADIAL" || name == "SIMPLE_RADIAL_FISHEYE") extra = {0.05};
  if (name == "RADIAL" || name == "RADIAL_FISHEYE") extra = {0.05, -0.08};
  if (name == "OPENCV") extra = {0.05, -0.08, 0.001, -0.002};
  if (name == "OPENCV_FISHEYE") extra = {0.05, -0.08, 0.03, -0.01};
  if (name == "FULL_OPENCV") extra = {0.05, -0.08, 0.001, -0.002, 0.01, 0.02, -0.01, 0.003};
  if (name == "FOV") extra = {0.6};
  if (name == "THIN_PRISM_FISHEYE") extra = {0.05, -0.08, 1e-4, -1e-4, 0.01, 0.0, 3e-5, -2e-5};
  parameters.insert(parameters.end(), extra.begin(), extra.end());
  return {7, *ColmapModelFromName(name), 4000, 3000, parameters};
}

TEST(ColmapCameras, EveryModelHasItsParametersAndSeesTheAxisAtThePrincipalPoint) {
  ASSERT_EQ(ColmapModels().size(), 11u);
  for (const ColmapModelInfo& info : ColmapModels()) {
    const ColmapCamera lens = Lens(std::string(info.name));
    ASSERT_EQ(lens.parameters.size(), info.parameters) << info.name;
    const Eigen::Vector2d axis = ColmapImagePoint(lens.model, lens.parameters, 0, 0);
    EXPECT_NEAR(axis.x(), 2010, 1e-9) << info.name;
    EXPECT_NEAR(axis.y(), 1490, 1e-9) << info.name;
  }
}

// θ = 45° at u = 1: the equidistant projection puts it at f·π/4.
TEST(ColmapCameras, FisheyeModelsBendByTheAngle) {
  const double theta = std::atan(1.0), bent = theta * (1 + 0.05 * theta * theta);
  const ColmapCamera simple = Lens("SIMPLE_RADIAL_FISHEYE");
  EXPECT_NEAR(ColmapImagePoint(simple.model, simple.parameters, 1, 0).x(), 2010 + 3000 * bent,
              1e-9);
  const ColmapCamera opencv{
      1, *ColmapModelFromName("OPENCV_FISHEYE"), 10, 10, {100, 200, 0, 0, 0, 0, 0, 0.5}};
  EXPECT_NEAR(ColmapImagePoint(opencv.model, opencv.parameters, 0, 1).y(),
              200 * theta * (1 + 0.5 * std::pow(theta, 8)), 1e-9);
  // Devernay and Faugeras: r_d = atan(2 r tan(ω/2)) / ω.
  const ColmapCamera fov = Lens("FOV");
  EXPECT_NEAR(ColmapImagePoint(fov.model, fov.parameters, 0.5, 0).x(),
              2010 + 3000 * std::atan(2 * 0.5 * std::tan(0.3)) / 0.6, 1e-9);
}

TEST(ColmapCameras, ConversionFollowsTheLensOverThePicture) {
  for (const ColmapModelInfo& info : ColmapModels()) {
    const ColmapCamera lens = Lens(std::string(info.name));
    const ConvertedCamera converted = ConvertCamera("cameras.txt", lens);
    EXPECT_EQ(converted.exact, CameraModelFromName(info.name).has_value()) << info.name;
    EXPECT_LE(converted.rms_px, converted.largest_px);
    // Prisms and tangential terms act on angles there and on tangents here.
    EXPECT_LT(converted.largest_px, info.name == "THIN_PRISM_FISHEYE" ? 0.3 : 0.1) << info.name;
    // Off the fit's grid.
    for (int i = 0; i < 200; ++i) {
      const double u = 0.66 * std::cos(2.4 * i) * i / 200, v = 0.48 * std::sin(2.4 * i) * i / 200;
      const Eigen::Vector2d right = ColmapImagePoint(lens.model, lens.parameters, u, v);
      if (right.x() < 0 || right.y() < 0 || right.x() > 4000 || right.y() > 3000) continue;
      const Eigen::Vector2d found = ImageFromCamera(converted.camera, Eigen::Vector3d(u, v, 1));
      EXPECT_LE((found - right).norm(), 1.5 * converted.largest_px + 1e-9) << info.name;
    }
  }
}

TEST(ColmapCameras, ALensThatSeesSidewaysIsRefused) {
  ColmapCamera wide = Lens("OPENCV_FISHEYE");
  wide.parameters = {1100, 1100, 2000, 1500, 0, 0, 0, 0};  // 130° and more to the corners
  try {
    ConvertCamera("model/cameras.bin", wide);
    FAIL() << "did not throw";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("model/cameras.bin: camera 7 (OPENCV_FISHEYE)"));
    EXPECT_THAT(error.what(), HasSubstr("undistort"));
  }
}

TEST(Similarity, AlignPointsFindsTheMotionAndMovedPosesKeepPictures) {
  Similarity3 truth;
  truth.scale = 37.5;
  truth.rotation = Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized()).matrix();
  truth.translation = {10, -400, 33};
  Eigen::Matrix3Xd a(3, 5), b(3, 5);
  a << 0, 1, 0.2, -1, 3, 0, 0.5, 2, 0.7, 1, 0, -0.3, 0.4, 1, 2;
  for (int i = 0; i < 5; ++i) b.col(i) = truth * Eigen::Vector3d(a.col(i));
  const auto found = AlignPoints(a, b);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->scale, truth.scale, 1e-10);
  EXPECT_TRUE(found->rotation.isApprox(truth.rotation, 1e-10));
  EXPECT_TRUE(found->translation.isApprox(truth.translation, 1e-10));
  const Rigid3 camera_from_a{Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).matrix(), {1, 2, 9}};
  const Eigen::Vector3d before = camera_from_a * Eigen::Vector3d(a.col(2));
  const Eigen::Vector3d after = MovedPose(camera_from_a, truth) * Eigen::Vector3d(b.col(2));
  EXPECT_TRUE(after.isApprox(truth.scale * before, 1e-10));
  EXPECT_TRUE((Inverse(truth) * (truth * before)).isApprox(before, 1e-10));

  Eigen::Matrix3Xd line(3, 4);
  line << 0, 1, 2, 3, 0, 2, 4, 6, 0, 3, 6, 9;
  EXPECT_FALSE(AlignPoints(line, line));
}

}  // namespace
}  // namespace glint
