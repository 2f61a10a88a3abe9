#include "calib/registration/register_sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace glint {
namespace {

constexpr double kSide_mm = 100;
constexpr double kMargin = 1.2;
constexpr int kSide_px = 256;

// Smooth noise of features about `scale_mm` wide, −1 … 1, and its slope.
class Noise {
 public:
  Noise(std::uint32_t seed, double scale_mm) : seed_(seed), scale_mm_(scale_mm) {}

  double At(double x_mm, double y_mm) const {
    const double x = x_mm / scale_mm_, y = y_mm / scale_mm_;
    const double x0 = std::floor(x), y0 = std::floor(y);
    const double u = Smooth(x - x0), v = Smooth(y - y0);
    const double top = (1 - u) * Node(x0, y0) + u * Node(x0 + 1, y0);
    const double bottom = (1 - u) * Node(x0, y0 + 1) + u * Node(x0 + 1, y0 + 1);
    return (1 - v) * top + v * bottom;
  }

 private:
  static double Smooth(double t) { return t * t * t * (10 + t * (6 * t - 15)); }
  double Node(double x, double y) const {
    std::uint32_t h = seed_ ^ (static_cast<std::uint32_t>(static_cast<int>(x)) * 0x9e3779b1u) ^
                      (static_cast<std::uint32_t>(static_cast<int>(y)) * 0x85ebca77u);
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return static_cast<double>(h ^ (h >> 15)) / 2147483648.0 - 1;
  }
  std::uint32_t seed_;
  double scale_mm_;
};

struct Scene {
  PlaneValues plane{0, 0, 0};
  double albedo = 0.4, relief = 0;      // of log radiance, by feature and by slope
  std::vector<Eigen::Vector2d> shifts;  // of each view's picture, mm
  int views = 9;
  int first_after = 9;     // of the views, the first after the sample was moved
  SampleMove move;         // by then
  bool exchanged = false;  // for another sample
};

Eigen::Vector3d Camera(int view) {
  const double azimuth = 2.4 * view, tilt = (8 + 3.5 * view) * 3.14159265 / 180;
  return 300 * Eigen::Vector3d(std::cos(azimuth) * std::sin(tilt),
                               std::sin(azimuth) * std::sin(tilt), std::cos(tilt));
}

double LogRadiance(const Scene& scene, const Eigen::Vector3d& light, double x, double y) {
  static const Noise albedo(1, 2.0), fine(2, 1.1), height(3, 1.6);
  constexpr double kStep = 0.05;
  const double slope_x = (height.At(x + kStep, y) - height.At(x - kStep, y)) / (2 * kStep);
  const double slope_y = (height.At(x, y + kStep) - height.At(x, y - kStep)) / (2 * kStep);
  const double lit = slope_x * (light.x() - x) / light.z() + slope_y * (light.y() - y) / light.z();
  // Valleys are darker: what makes moving shading look like parallax.
  return -1.5 + scene.albedo * (albedo.At(x, y) + 0.5 * fine.At(x, y)) +
         scene.relief * (0.5 * height.At(x, y) - lit);
}

RegistrationProblem ProblemOf(const Scene& scene) {
  RegistrationProblem problem;
  problem.sample_width_mm = problem.sample_height_mm = kSide_mm;
  problem.margin = kMargin;
  problem.height_sd_mm = 10;
  problem.homography_sd_mm = 0.02;
  problem.may_have_moved = true;
  const int side = static_cast<int>(kMargin * kSide_px);
  for (int view = 0; view < scene.views; ++view) {
    TopView top{side, side, {}, Camera(view)};
    const Eigen::Vector3d light = Camera(view) + Eigen::Vector3d(10, 0, 0);
    const PlaneFrame<double> frame(scene.plane.data());
    const Eigen::Vector2d shift =
        scene.shifts.empty() ? Eigen::Vector2d(0, 0) : scene.shifts[static_cast<size_t>(view)];
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        const double x = ((column + 0.5) / side - 0.5) * kMargin * kSide_mm - shift.x();
        const double y = (0.5 - (row + 0.5) / side) * kMargin * kSide_mm - shift.y();
        Eigen::Vector2d point;
        frame.SampleFromAssumed(top.camera_mm, x, y, point.data());
        if (view >= scene.first_after) {
          point = Eigen::Rotation2Dd(-scene.move.turn_rad) * (point - scene.move.shift_mm);
          if (scene.exchanged) point.x() += 1000;
        }
        top.radiance.push_back(
            static_cast<float>(std::exp(LogRadiance(scene, light, point.x(), point.y()))));
      }
    }
    problem.views.push_back(top);
  }
  return problem;
}

double OffInDeviations(const SampleRegistration& found, const PlaneValues& truth) {
  double most = 0;
  for (int i = 0; i < 3; ++i) {
    const double sigma = std::sqrt(found.plane_covariance(i, i));
    most = std::max(
        most,
        std::abs(found.plane[static_cast<size_t>(i)] - truth[static_cast<size_t>(i)]) / sigma);
  }
  return most;
}

TEST(RegisterSample, HeightAndTiltLieWithinThreeStatedDeviations) {
  for (const PlaneValues& plane :
       {PlaneValues{-2, 0, 0}, PlaneValues{3, 0, 0}, PlaneValues{15, 0.0175, 0},
        PlaneValues{0.5, 0, 0}, PlaneValues{8, -0.012, 0.012}}) {
    Scene scene;
    scene.plane = plane;
    const SampleRegistration found = RegisterSample(ProblemOf(scene), 2);
    EXPECT_TRUE(found.told);
    EXPECT_NEAR(found.plane[0], plane[0], 0.15);
    EXPECT_LT(OffInDeviations(found, plane), 3) << plane[0];
  }
}

TEST(RegisterSample, FlatSampleStaysExactlyInItsPlane) {
  const SampleRegistration found = RegisterSample(ProblemOf({}), 2);
  EXPECT_EQ(found.plane, (PlaneValues{0, 0, 0}));
  for (const Eigen::Matrix3d& homography : found.homographies) {
    EXPECT_TRUE(homography.isIdentity(0));
  }
}

TEST(RegisterSample, ShadingThatMovesWithTheLightIsNoHeight) {
  for (const double height_mm : {0.0, 3.0}) {
    Scene scene;
    scene.albedo = 0.1;
    scene.relief = 0.5;
    scene.plane[0] = height_mm;
    const SampleRegistration found = RegisterSample(ProblemOf(scene), 2);
    EXPECT_NEAR(found.plane[0], height_mm, 0.15);
    EXPECT_LT(OffInDeviations(found, scene.plane), 3);
  }
}

TEST(RegisterSample, WithoutTextureThePriorStays) {
  Scene scene;
  scene.albedo = 0;
  RegistrationProblem problem = ProblemOf(scene);
  problem.height_mm = 1.5;
  // The sensor's noise, another in each view.
  std::uint32_t state = 1;
  for (TopView& view : problem.views) {
    for (float& value : view.radiance) {
      state = state * 1664525u + 1013904223u;
      value *= 1 + 0.02f * (static_cast<float>(state >> 8) / 8388608.0f - 1);
    }
  }
  const SampleRegistration found = RegisterSample(problem, 2);
  EXPECT_FALSE(found.told);
  EXPECT_EQ(found.plane, (PlaneValues{1.5, 0, 0}));
  EXPECT_EQ(found.height_sd_mm(), 10);
}

TEST(RegisterSample, HeldHeightIsKept) {
  Scene scene;
  scene.plane[0] = 3;
  RegistrationProblem problem = ProblemOf(scene);
  problem.height_mm = 2;
  problem.height_sd_mm = 0;
  EXPECT_EQ(RegisterSample(problem, 2).plane, (PlaneValues{2, 0, 0}));
}

TEST(RegisterSample, PhotographsOutOfPlaceAreBroughtTogether) {
  Scene scene;
  for (int view = 0; view < scene.views; ++view) {
    scene.shifts.emplace_back(0.5 * std::sin(5.0 * view), 0.5 * std::cos(3.0 * view));
  }
  RegistrationProblem problem = ProblemOf(scene);
  problem.height_sd_mm = 2;
  problem.homography_sd_mm = 0.4;
  problem.often_as_said = problem.may_have_moved = false;
  const SampleRegistration found = RegisterSample(problem, 2);
  // Where a view shows the sample's centre, less where it is: the same in all views.
  Eigen::Vector2d mean(0, 0);
  std::vector<Eigen::Vector2d> off;
  for (size_t view = 0; view < scene.shifts.size(); ++view) {
    const Eigen::Matrix3d seen =
        AssumedFromSample(found.plane, problem.views[view].camera_mm) * found.homographies[view];
    off.push_back((seen * Eigen::Vector3d(0, 0, 1)).hnormalized() - scene.shifts[view]);
    mean += off.back() / static_cast<double>(scene.shifts.size());
  }
  for (const Eigen::Vector2d& one : off) EXPECT_LT((one - mean).norm(), 0.1);
  EXPECT_GT(found.displaced_before_mm, 0.3);
  EXPECT_LT(found.displaced_after_mm, 0.1);
}

// Where a view shows a point of the sample, less where it would be had it not been moved.
Eigen::Vector2d Off(const SampleRegistration& found, int view, const SampleMove& truth) {
  const Eigen::Vector2d point(30, -30);
  const auto v = static_cast<size_t>(view);
  const auto at = [](const SampleMove& move, const Eigen::Vector2d& p) {
    return Eigen::Vector2d(Eigen::Rotation2Dd(move.turn_rad) * p + move.shift_mm);
  };
  return at(found.moves[v], (found.homographies[v] * point.homogeneous()).hnormalized()) -
         at(truth, point);
}

void ExpectMoves(const Scene& scene, const SampleRegistration& found, double most_off_mm) {
  ASSERT_EQ(std::ssize(found.moves), scene.views);
  std::vector<Eigen::Vector2d> off;
  Eigen::Vector2d mean(0, 0);  // common to all
  for (int view = 0; view < scene.views; ++view) {
    const bool moved = view >= scene.first_after;
    EXPECT_EQ(found.moves[static_cast<size_t>(view)].none(), !moved) << view;
    off.push_back(Off(found, view, moved ? scene.move : SampleMove{}));
    mean += off.back() / scene.views;
  }
  for (const Eigen::Vector2d& one : off) EXPECT_LT((one - mean).norm(), most_off_mm);
}

TEST(RegisterSample, SampleThatWasMovedIsFollowed) {
  for (const double height_mm : {0.0, 3.0}) {
    for (const double relief : {0.0, 0.4}) {
      Scene scene;
      scene.plane[0] = height_mm;
      scene.relief = relief;
      scene.albedo = relief > 0 ? 0.2 : 0.4;
      scene.first_after = 6;
      scene.move = {0.035, {3, -1.2}};
      const SampleRegistration found = RegisterSample(ProblemOf(scene), 2);
      // Shading that moves with the light seems displaced itself; a pixel is 0.39 mm.
      ExpectMoves(scene, found, relief > 0 ? 0.25 : 0.1);
      EXPECT_TRUE(found.textures.empty());
      EXPECT_NEAR(found.plane[0], height_mm, 0.2);
      EXPECT_LT(OffInDeviations(found, scene.plane), 3);
    }
  }
}

TEST(RegisterSample, MotionOfAMillimetreIsNoHeight) {
  Scene scene;
  scene.first_after = 5;
  scene.move.shift_mm = {0.9, 0.4};
  const SampleRegistration found = RegisterSample(ProblemOf(scene), 2);
  EXPECT_FALSE(found.moves.empty());
  EXPECT_LT(OffInDeviations(found, scene.plane), 3);
}

TEST(RegisterSample, SampleThatWasExchangedIsTold) {
  for (const int first_after : {5, 8}) {
    Scene scene;
    scene.first_after = first_after;
    scene.exchanged = true;
    const SampleRegistration found = RegisterSample(ProblemOf(scene), 2);
    ASSERT_EQ(std::ssize(found.textures), scene.views);
    for (int view = 0; view < scene.views; ++view) {
      EXPECT_EQ(found.textures[static_cast<size_t>(view)], view >= first_after) << view;
    }
  }
}

TEST(RegisterSample, WhatWasLeftAloneWasNeitherMovedNorExchanged) {
  for (const double relief : {0.0, 0.5}) {
    Scene scene;
    scene.relief = relief;
    scene.albedo = relief > 0 ? 0.05 : 0.4;
    scene.plane = {2, 0.01, 0};
    const SampleRegistration found = RegisterSample(ProblemOf(scene), 2);
    EXPECT_TRUE(found.moves.empty());
    EXPECT_TRUE(found.textures.empty());
  }
}

TEST(RegisterSample, TwoViewsAreComparedAsAPair) {
  Scene scene;
  scene.views = 2;
  scene.plane[0] = 3;
  const SampleRegistration found = RegisterSample(ProblemOf(scene), 2);
  EXPECT_TRUE(found.told);
  EXPECT_NEAR(found.plane[0], 3, 0.3);
}

TEST(RegisterSample, OneViewTellsNothing) {
  Scene scene;
  scene.views = 1;
  EXPECT_FALSE(RegisterSample(ProblemOf(scene), 2).told);
  EXPECT_FALSE(RegisterSample({}, 2).told);
}

TEST(RegisterSample, TheSameForAnyNumberOfThreads) {
  Scene scene;
  scene.plane = {3, 0.01, 0};
  const RegistrationProblem problem = ProblemOf(scene);
  const SampleRegistration one = RegisterSample(problem, 1), three = RegisterSample(problem, 3);
  EXPECT_EQ(one.plane, three.plane);
  EXPECT_EQ(one.plane_covariance, three.plane_covariance);
  EXPECT_EQ(one.homographies, three.homographies);
}

TEST(RegisterSample, ViewsOfDifferentSizesAreRefused) {
  RegistrationProblem problem = ProblemOf({});
  problem.views[1].radiance.pop_back();
  EXPECT_THROW(RegisterSample(problem, 1), std::invalid_argument);
}

TEST(SamplePlace, SeenPointsAreOnTheirRays) {
  const PlaneValues plane{3, 0.02, -0.01};
  const Eigen::Vector3d camera(120, -40, 280);
  const PlaneFrame<double> frame(plane.data());
  double seen[2], back[2];
  frame.AssumedFromSample(camera, 20.0, -30.0, seen);
  frame.SampleFromAssumed(camera, seen[0], seen[1], back);
  EXPECT_NEAR(back[0], 20, 1e-9);
  EXPECT_NEAR(back[1], -30, 1e-9);
  const Eigen::Vector2d by_matrix =
      (AssumedFromSample(plane, camera) * Eigen::Vector3d(20, -30, 1)).hnormalized();
  EXPECT_NEAR(by_matrix.x(), seen[0], 1e-9);
  EXPECT_NEAR(by_matrix.y(), seen[1], 1e-9);
  const Eigen::Vector3d point = AssumedFromSample(plane) * Eigen::Vector3d(20, -30, 0);
  EXPECT_NEAR(point.z(), 3 + 0.02 * point.x() - 0.01 * point.y(), 1e-9);
  EXPECT_LT((point - camera).cross(Eigen::Vector3d(seen[0], seen[1], 0) - camera).norm(), 1e-6);
}

}  // namespace
}  // namespace glint
