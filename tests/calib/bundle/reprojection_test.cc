#include "calib/bundle/reprojection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calib/bundle/cost.h"
#include "tests/calib/testing/synthetic_photo.h"

namespace glint {
namespace {

// The Jacobian that the solver uses against central differences of the same residual, written out
// here once more: 1,000 random points, each model, 1e-6 of the row's size.
TEST(ReprojectionError, DerivativesAgreeWithFiniteDifferences) {
  testing::Random random(7);
  double worst = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const CameraModel model = kCameraModels[trial % kCameraModels.size()].model;
    std::vector<double> camera;
    for (const std::string& name : CameraParameterNames(model)) {
      camera.push_back(name[0] == 'f'   ? random.Uniform(500, 4000)
                       : name[0] == 'c' ? random.Uniform(300, 2000)
                       : name[0] == 'p' ? random.Uniform(-0.01, 0.01)
                                        : random.Uniform(-0.2, 0.2));
    }
    const Rigid3 start = testing::LookAt(random.Uniform(150, 400), random.Uniform(0, 50),
                                         random.Uniform(0, 360), random.Uniform(-180, 180));
    const BundleCorner corner{0,
                              {random.Uniform(-90, 90), random.Uniform(-90, 90)},
                              {random.Uniform(0, 4000), random.Uniform(0, 3000)}};
    std::vector<double> pose;
    for (int i = 0; i < 3; ++i) pose.push_back(random.Uniform(-0.1, 0.1));
    for (int i = 0; i < 3; ++i) pose.push_back(start.translation[i] + random.Uniform(-5, 5));

    const int n = static_cast<int>(camera.size());
    std::vector<double> j_camera(2 * n), j_pose(12);
    double residual[2];
    const double* parameters[] = {camera.data(), pose.data()};
    double* jacobians[] = {j_camera.data(), j_pose.data()};
    const auto cost = bundle::MakeCost(model, start.rotation, corner, {}, false);
    ASSERT_TRUE(cost->Evaluate(parameters, residual, jacobians));

    const auto predicted = [&](const std::vector<double>& c, const std::vector<double>& p) {
      const Eigen::Vector3d w(p[0], p[1], p[2]);
      const Rigid3 rigid{Eigen::AngleAxisd(w.norm(), w.normalized()) * start.rotation,
                         Eigen::Vector3d(p[3], p[4], p[5])};
      return testing::Project({model, 4000, 3000, c}, rigid, corner.position_in_sample_mm);
    };
    EXPECT_NEAR(predicted(camera, pose).x() - corner.point_px.x(), residual[0], 1e-6);
    for (int k = 0; k < n + 6; ++k) {
      auto& block = k < n ? camera : pose;
      const int index = k < n ? k : k - n;
      const double value = block[index];
      const double h = 1e-5 * std::max(std::abs(value), k < n ? 1e-1 : 1.0);
      // Fourth order, so that the differences' own error stays below what is tested.
      Eigen::Vector2d sample[4];
      const double steps[] = {-2, -1, 1, 2};
      for (int i = 0; i < 4; ++i) {
        block[index] = value + steps[i] * h;
        sample[i] = predicted(camera, pose);
      }
      block[index] = value;
      const Eigen::Vector2d numeric =
          (sample[0] - 8 * sample[1] + 8 * sample[2] - sample[3]) / (12 * h);
      const double* row = k < n ? j_camera.data() : j_pose.data();
      const int stride = k < n ? n : 6;
      for (int r = 0; r < 2; ++r) {
        const double size = std::max(1.0, numeric.norm());
        const double error = std::abs(row[r * stride + index] - numeric[r]) / size;
        worst = std::max(worst, error);
        EXPECT_LE(error, 1e-6) << CameraModelName(model) << " parameter " << k;
      }
    }
  }
  std::printf("largest relative difference: %.2g\n", worst);
}

TEST(ReprojectionError, RefusesPointsBehindTheCamera) {
  const auto cost = bundle::MakeCost(CameraModel::kSimplePinhole, Eigen::Matrix3d::Identity(),
                                     {0, {1, 2}, {3, 4}}, {}, false);
  const double camera[] = {1000, 500, 500}, pose[] = {0, 0, 0, 0, 0, -10};
  const double* parameters[] = {camera, pose};
  double residual[2];
  EXPECT_FALSE(cost->Evaluate(parameters, residual, nullptr));
}

}  // namespace
}  // namespace glint
