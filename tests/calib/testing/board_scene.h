// Corners of a frame board as a phone sees it from many sides, with the faults that phones, boards
// and hands have. No pictures: corners alone.
#pragma once

#include <cstdint>
#include <vector>

#include "calib/bundle/bundle.h"
#include "tests/calib/testing/synthetic_photo.h"

namespace glint::testing {

Board FrameBoard();  // 12 × 12 squares of 15 mm, the middle 6 × 6 left out

// 4000 × 3000 pixels, about 65 degrees wide, with distortion as the model has it.
Camera PhoneCamera(CameraModel model);

struct SceneSettings {
  int photos = 12;
  double noise_px = 0.15;
  std::uint64_t seed = 1;
  double tilt_scale = 1;  // of tilts from 5 degrees up in steps of `tilt_step_deg`
  double tilt_step_deg = 3;
  Eigen::Vector2d bend_mm{0, 0};       // see BoardBend
  std::vector<int> moved;              // photos in which the camera moves while rows are read …
  Eigen::Vector3d motion_mm{0, 0, 0};  // … by this over the picture's height
  std::vector<int> blurred;            // photos whose corners scatter along …
  double blur_deg = 30, blur_px = 1;   // … this direction by this standard deviation
};

struct Scene {
  BundleProblem problem;
  std::vector<Rigid3> poses;
};

Scene MakeScene(const Camera& camera, const SceneSettings& settings);

}  // namespace glint::testing
