// The direction of the light from its reflection in a ball (a black billiard ball, a steel ball)
// that lies in the picture: what people use in the field in place of a dome (Malzbender, Gelb,
// Wolters 2001; "highlight RTI", Mudge et al. 2006).
//
// The camera is far: at the reflection, (x, y) off the ball's middle, the ball's normal is n = (x,
// y, √(r² − x² − y²)) / r, and the light is where the view v = (0, 0, 1) is mirrored: 2 (n·v) n −
// v.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace glint {

// In pixels of the upright picture; y down.
struct BallOutline {
  Eigen::Vector2d centre_px{0, 0};
  double radius_px = 0;
};

// The circle through three points of its rim. nullopt: they lie on a line.
std::optional<BallOutline> CircleThrough(const std::array<Eigen::Vector2d, 3>& points_px);

// Brightness of the picture's part about a ball, row-major, by whatever increases with radiance.
struct BallPicture {
  int left_px = 0, top_px = 0, width = 0, height = 0;
  std::vector<float> brightness;
};

// Toward the light: x right, y up, z to the camera. The reflection is the brightest spot that lies
// within the ball. nullopt: nothing on it stands out.
std::optional<Eigen::Vector3d> LightFromBall(const BallPicture& picture, const BallOutline& ball);

}  // namespace glint
