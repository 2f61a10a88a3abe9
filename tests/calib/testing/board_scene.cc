#include "tests/calib/testing/board_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace glint::testing {
namespace {

bool Contains(const std::vector<int>& list, int value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

// The image of a point while the camera moves: at the row where it is seen.
Eigen::Vector2d SeenWhileMoving(const Camera& camera, const Rigid3& pose,
                                const Eigen::Vector3d& point, const Eigen::Vector3d& motion_mm) {
  Eigen::Vector2d at = ImageFromCamera(camera, pose * point);
  for (int i = 0; i < 5; ++i) {
    at = ImageFromCamera(camera, pose * point + motion_mm * (at.y() / camera.height_px - 0.5));
  }
  return at;
}

}  // namespace

Board FrameBoard() {
  Board board;
  board.squares_x = board.squares_y = 12;
  board.square_mm = 15;
  board.marker_mm = 11;
  board.window = BoardWindow{3, 3, 6, 6};
  return board;
}

Camera PhoneCamera(CameraModel model) {
  switch (model) {
    case CameraModel::kSimpleRadial:
      return {model, 4000, 3000, {3100, 2011, 1489, 0.04}};
    case CameraModel::kRadial:
      return {model, 4000, 3000, {3100, 2011, 1489, 0.06, -0.09}};
    case CameraModel::kOpenCv:
      return {model, 4000, 3000, {3100, 3105, 2011, 1489, 0.06, -0.09, 4e-4, -6e-4}};
    case CameraModel::kOpenCvFisheye:
      return {model, 4000, 3000, {3100, 3105, 2011, 1489, 0.06, -0.09, 0.03, -0.01}};
    case CameraModel::kSimpleRadialFisheye:
      return {model, 4000, 3000, {3100, 2011, 1489, 0.04}};
    case CameraModel::kRadialFisheye:
      return {model, 4000, 3000, {3100, 2011, 1489, 0.06, -0.09}};
    default:
      return {CameraModel::kFullOpenCv,
              4000,
              3000,
              {3100, 3105, 2011, 1489, 0.2, 0.1, 4e-4, -6e-4, -0.02, 0.15, 0.05, 0.01}};
  }
}

Scene MakeScene(const Camera& camera, const SceneSettings& settings) {
  Random random(settings.seed);
  BoardBend bend;
  bend.half_size_mm = {75, 75};  // of the board's corners
  bend.height_mm = settings.bend_mm;
  const double blur = settings.blur_deg * std::numbers::pi / 180;
  Scene scene;
  scene.problem.cameras.push_back({camera.width_px, camera.height_px, {}});
  for (int i = 0; i < settings.photos; ++i) {
    const Rigid3 pose =
        LookAt(260 + 8 * i, settings.tilt_scale * (5 + settings.tilt_step_deg * i), 77 * i,
               29 * i - 90, {random.Uniform(-10, 10), random.Uniform(-10, 10)});
    BundlePhoto photo{"photo" + std::to_string(i) + ".jpg", 0, {}};
    const Eigen::Vector3d motion =
        Contains(settings.moved, i) ? settings.motion_mm : Eigen::Vector3d(0, 0, 0);
    for (const BoardCorner& corner : BoardCorners(FrameBoard())) {
      const Eigen::Vector2d& xy = corner.position_in_sample_mm;
      Eigen::Vector2d at =
          SeenWhileMoving(camera, pose, {xy.x(), xy.y(), bend.HeightAt(xy)}, motion);
      if (at.x() < 10 || at.y() < 10 || at.x() > camera.width_px - 10 ||
          at.y() > camera.height_px - 10) {
        continue;
      }
      at += settings.noise_px * Eigen::Vector2d(random.Normal(), random.Normal());
      if (Contains(settings.blurred, i)) {
        at += settings.blur_px * random.Normal() * Eigen::Vector2d(std::cos(blur), std::sin(blur));
      }
      photo.corners.push_back({corner.id, xy, at});
    }
    scene.poses.push_back(pose);
    scene.problem.photos.push_back(std::move(photo));
  }
  return scene;
}

}  // namespace glint::testing
