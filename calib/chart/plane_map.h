// The homography between a chart and its picture.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

namespace glint {

// That takes each of four points to its counterpart. Not invertible where three of them lie on a
// line.
Eigen::Matrix3d MapOfFourPoints(const std::array<Eigen::Vector2d, 4>& from,
                                const std::array<Eigen::Vector2d, 4>& to);

inline Eigen::Vector2d Mapped(const Eigen::Matrix3d& map, const Eigen::Vector2d& point) {
  return (map * point.homogeneous()).hnormalized();
}

// Corners of a rectangle from (left, top), clockwise.
inline std::array<Eigen::Vector2d, 4> CornersOf(const Eigen::Vector2d& top_left,
                                                const Eigen::Vector2d& bottom_right) {
  return {
      {top_left, {bottom_right.x(), top_left.y()}, bottom_right, {top_left.x(), bottom_right.y()}}};
}

}  // namespace glint
