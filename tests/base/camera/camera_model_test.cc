#include <gtest/gtest.h>

#include "base/camera/camera_model.h"

namespace glint {
namespace {

Camera Phone(CameraModel model) {
  Camera camera{model, 4000, 3000, {}};
  for (const std::string& name : CameraParameterNames(model)) {
    double value = 0.001;
    if (name[0] == 'f') value = name == "fy" ? 3010 : 3000;
    if (name == "cx") value = 2010;
    if (name == "cy") value = 1490;
    if (name == "k" || name == "k1") value = 0.09;
    if (name == "k2") value = -0.12;
    camera.parameters.push_back(value);
  }
  return camera;
}

TEST(CameraModel, UndistortionInvertsDistortionOverTheWholeImage) {
  for (const CameraModel model :
       {CameraModel::kSimplePinhole, CameraModel::kPinhole, CameraModel::kSimpleRadial,
        CameraModel::kRadial, CameraModel::kOpenCv, CameraModel::kFullOpenCv}) {
    const Camera camera = Phone(model);
    for (double x = 0; x <= 4000; x += 500) {
      for (double y = 0; y <= 3000; y += 500) {
        const auto uv = NormalizedFromImage(camera, {x, y});
        ASSERT_TRUE(uv) << CameraModelName(model);
        const Eigen::Vector2d back = ImageFromCamera(camera, {uv->x() * 7, uv->y() * 7, 7});
        EXPECT_NEAR(back.x(), x, 1e-5);
        EXPECT_NEAR(back.y(), y, 1e-5);
      }
    }
  }
}

TEST(CameraModel, FoldedDistortionHasNoInverse) {
  Camera camera = Phone(CameraModel::kSimpleRadial);
  camera.parameters[3] = -2.0;  // r(1 − 2r²) never exceeds 0.27
  EXPECT_FALSE(NormalizedFromImage(camera, {4000, 3000}));
}

TEST(CameraModel, NamesRoundTrip) {
  for (const char* name :
       {"SIMPLE_PINHOLE", "PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV", "FULL_OPENCV"}) {
    EXPECT_EQ(CameraModelName(*CameraModelFromName(name)), name);
  }
  EXPECT_FALSE(CameraModelFromName("FISHEYE"));
}

TEST(CameraModel, ScalingTheImageScalesItsPoints) {
  const Camera camera = Phone(CameraModel::kOpenCv);
  const Eigen::Vector3d point(0.1, -0.2, 1);
  EXPECT_TRUE(ImageFromCamera(ScaledCamera(camera, 0.5), point)
                  .isApprox(0.5 * ImageFromCamera(camera, point), 1e-12));
}

}  // namespace
}  // namespace glint
