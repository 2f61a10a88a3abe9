// Where a flat sample lies, and where a photograph shows it: the maps between the assumed plane,
// z = 0, in which a photograph was or would be rectified, and the sample's own plane.
//
// The sample's plane is z = height + slope_x·x + slope_y·y in the assumed frame. Its own frame has
// its origin at (0, 0, height) and its axes turned by the least turn that takes z to its normal. A
// camera at c sees a point of the plane where the ray from c meets z = 0; what is left (pose, lens)
// is a homography of the plane, near the identity, a photograph.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>

#include "base/camera/rigid3.h"

namespace glint {

// Height in millimetres, then the slopes along x and y.
using PlaneValues = std::array<double, 3>;

// A motion of the sample in its plane: its point p lies at turn · p + shift.
struct SampleMove {
  double turn_rad = 0;  // counter-clockwise as seen from above
  Eigen::Vector2d shift_mm{0, 0};

  bool none() const { return turn_rad == 0 && shift_mm.isZero(0); }
  Rigid3 Motion() const {
    Rigid3 motion;
    motion.rotation.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(turn_rad).toRotationMatrix();
    motion.translation << shift_mm, 0;
    return motion;
  }
};

// A homography as what it adds to the identity, (x, y, 1) in units of `unit_mm`:
// ((1 + h0) x + h1 y + h2, h3 x + (1 + h4) y + h5) / (h6 x + h7 y + 1).
using HomographyValues = std::array<double, 8>;

// The sample's frame in the assumed one.
template <class T>
struct PlaneFrame {
  T origin_z, normal[3], x_axis[3], y_axis[3];

  explicit PlaneFrame(const T* plane) : origin_z(plane[0]) {
    using std::sqrt;
    const T length = sqrt(T(1.0) + plane[1] * plane[1] + plane[2] * plane[2]);
    const T nx = -plane[1] / length, ny = -plane[2] / length, nz = T(1.0) / length;
    const T share = T(1.0) / (T(1.0) + nz);
    const T axes[3][3] = {{T(1.0) - nx * nx * share, -nx * ny * share, -nx},
                          {-nx * ny * share, T(1.0) - ny * ny * share, -ny},
                          {nx, ny, nz}};
    for (int i = 0; i < 3; ++i) {
      x_axis[i] = axes[0][i];
      y_axis[i] = axes[1][i];
      normal[i] = axes[2][i];
    }
  }

  // Where a camera sees the point (x, y) of the sample's plane: on the assumed plane.
  void AssumedFromSample(const Eigen::Vector3d& camera_mm, const T& x, const T& y, T* seen) const {
    T point[3];
    for (int i = 0; i < 3; ++i) point[i] = x_axis[i] * x + y_axis[i] * y;
    point[2] += origin_z;
    const T down = point[2] / (T(camera_mm[2]) - point[2]);
    for (int i = 0; i < 2; ++i) seen[i] = point[i] + down * (point[i] - T(camera_mm[i]));
  }

  // Its inverse.
  void SampleFromAssumed(const Eigen::Vector3d& camera_mm, const T& x, const T& y, T* point) const {
    const T ray[3] = {x - T(camera_mm[0]), y - T(camera_mm[1]), T(-camera_mm[2])};
    const T from_origin[3] = {T(camera_mm[0]), T(camera_mm[1]), T(camera_mm[2]) - origin_z};
    T above = T(0.0), sinks = T(0.0);
    for (int i = 0; i < 3; ++i) {
      above += normal[i] * from_origin[i];
      sinks += normal[i] * ray[i];
    }
    const T along = -above / sinks;
    point[0] = point[1] = T(0.0);
    for (int i = 0; i < 3; ++i) {
      const T at = from_origin[i] + along * ray[i];
      point[0] += x_axis[i] * at;
      point[1] += y_axis[i] * at;
    }
  }
};

template <class T>
void ApplyHomography(const T* h, double unit_mm, const T& x_mm, const T& y_mm, T* out_mm) {
  const T x = x_mm / T(unit_mm), y = y_mm / T(unit_mm);
  const T w = h[6] * x + h[7] * y + T(1.0);
  out_mm[0] = T(unit_mm) * (x + h[0] * x + h[1] * y + h[2]) / w;
  out_mm[1] = T(unit_mm) * (y + h[3] * x + h[4] * y + h[5]) / w;
}

// Of (x_mm, y_mm, 1).
inline Eigen::Matrix3d HomographyMatrix(const HomographyValues& h, double unit_mm) {
  Eigen::Matrix3d matrix;
  matrix << 1 + h[0], h[1], h[2] * unit_mm, h[3], 1 + h[4], h[5] * unit_mm, h[6] / unit_mm,
      h[7] / unit_mm, 1;
  return matrix;
}

// Where a camera sees points (x, y, 1) of the sample's plane on the assumed one, as a homography.
inline Eigen::Matrix3d AssumedFromSample(const PlaneValues& plane,
                                         const Eigen::Vector3d& camera_mm) {
  const PlaneFrame<double> frame(plane.data());
  Eigen::Matrix3d point;  // of the sample's plane in the assumed frame
  for (int i = 0; i < 3; ++i) {
    point.row(i) << frame.x_axis[i], frame.y_axis[i], i == 2 ? frame.origin_z : 0;
  }
  Eigen::Matrix3d seen;
  for (int i = 0; i < 2; ++i) {
    seen.row(i) = camera_mm.z() * point.row(i) - camera_mm[i] * point.row(2);
  }
  seen.row(2) << -point(2, 0), -point(2, 1), camera_mm.z() - point(2, 2);
  return seen / seen(2, 2);
}

// assumed_from_sample as a motion.
inline Rigid3 AssumedFromSample(const PlaneValues& plane) {
  const PlaneFrame<double> frame(plane.data());
  Rigid3 motion;
  for (int i = 0; i < 3; ++i) {
    motion.rotation(i, 0) = frame.x_axis[i];
    motion.rotation(i, 1) = frame.y_axis[i];
    motion.rotation(i, 2) = frame.normal[i];
  }
  motion.translation = {0, 0, frame.origin_z};
  return motion;
}

}  // namespace glint
