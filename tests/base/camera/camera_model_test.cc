#include <gtest/gtest.h>

#include <cmath>

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
  for (const CameraModelInfo& info : kCameraModels) {
    const CameraModel model = info.model;
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
  for (const CameraModelInfo& info : kCameraModels) {
    EXPECT_EQ(CameraModelName(info.model), info.name);
    EXPECT_EQ(CameraModelFromName(info.name), info.model);
  }
  EXPECT_FALSE(CameraModelFromName("FISHEYE"));
}

TEST(CameraModel, FocalLengthsAndThePrincipalPointComeFirst) {
  for (const CameraModelInfo& info : kCameraModels) {
    const size_t centre = PrincipalPointIndex(info.model);
    for (size_t i = 0; i < info.parameters.size(); ++i) {
      const auto kind = info.parameters[i].kind;
      EXPECT_EQ(kind == CameraParameter::kFocalLength, i < centre) << info.name;
      EXPECT_EQ(kind == CameraParameter::kPrincipalPoint, i == centre || i == centre + 1);
    }
  }
}

// θ = 45° at u = 1: the equidistant projection puts it at f·π/4.
TEST(CameraModel, FisheyesBendByTheAngle) {
  const double theta = std::atan(1.0);
  const Camera simple{CameraModel::kSimpleRadialFisheye, 10, 10, {100, 5, 6, 0.05}};
  EXPECT_NEAR(ImageFromCamera(simple, {2, 0, 2}).x(), 5 + 100 * theta * (1 + 0.05 * theta * theta),
              1e-9);
  const Camera opencv{CameraModel::kOpenCvFisheye, 10, 10, {100, 200, 5, 6, 0, 0, 0, 0.5}};
  EXPECT_NEAR(ImageFromCamera(opencv, {0, 2, 2}).y(),
              6 + 200 * theta * (1 + 0.5 * std::pow(theta, 8)), 1e-9);
}

// Where the closed form has no derivative the series takes over: value and slope go on.
TEST(CameraModel, FisheyesAreSmoothAtTheAxis) {
  const double k[] = {0.05};
  const auto bent = [&](double u) {
    double x, y;
    Distorted(CameraModel::kSimpleRadialFisheye, k, u, 0.0, &x, &y);
    return x;
  };
  EXPECT_EQ(bent(0), 0);
  EXPECT_NEAR(bent(1.0001e-4) - bent(0.9999e-4), 0.0002e-4, 1e-15);
}

TEST(CameraModel, ScalingTheImageScalesItsPoints) {
  const Camera camera = Phone(CameraModel::kOpenCv);
  const Eigen::Vector3d point(0.1, -0.2, 1);
  EXPECT_TRUE(ImageFromCamera(ScaledCamera(camera, 0.5), point)
                  .isApprox(0.5 * ImageFromCamera(camera, point), 1e-12));
}

}  // namespace
}  // namespace glint
