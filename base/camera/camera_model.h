// COLMAP's camera models and parameter order (https://colmap.github.io/cameras.html), as values.
//
// Image coordinates: pixels, the centre of the top-left pixel is (0.5, 0.5), as in COLMAP.
// Camera frame: x right, y down, z forward. u = x/z, v = y/z; distortion acts on (u, v).
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

enum class CameraModel { kSimplePinhole, kPinhole, kSimpleRadial, kRadial, kOpenCv, kFullOpenCv };

// To add a model: its name and parameters in camera_model.cc, its enumerator above and its
// projection in ImageFromNormalized() below.

// COLMAP's name ("SIMPLE_RADIAL" …) and its inverse (nullopt: unknown name).
std::string_view CameraModelName(CameraModel model);
std::optional<CameraModel> CameraModelFromName(std::string_view name);

// Those that glint-calib offers, from the fewest parameters on; others are read from elsewhere.
const std::vector<CameraModel>& CalibratedModels();
// "SIMPLE_PINHOLE, PINHOLE …", all of them, for messages.
std::string CameraModelNamesText();

// Parameter names in order, for manifests, tables and covariances:
//   SIMPLE_PINHOLE f cx cy · PINHOLE fx fy cx cy · SIMPLE_RADIAL f cx cy k · RADIAL f cx cy k1 k2
//   OPENCV fx fy cx cy k1 k2 p1 p2 · FULL_OPENCV fx fy cx cy k1 k2 p1 p2 k3 k4 k5 k6
const std::vector<std::string>& CameraParameterNames(CameraModel model);

struct Camera {
  CameraModel model = CameraModel::kSimpleRadial;
  int width_px = 0;
  int height_px = 0;
  std::vector<double> parameters;
  // The lens's fall-off (v1, v2, v3), see Vignetting(); zeros: none, or not known.
  std::array<double, 3> vignetting{0, 0, 0};

  double focal_length_x() const { return parameters[0]; }
  double focal_length_y() const;
};

// Image point of the normalised camera point (u, v). T is double or a Jet; `p` are the parameters.
template <class T>
void ImageFromNormalized(CameraModel model, const T* p, const T& u, const T& v, T* x_px, T* y_px) {
  const T r2 = u * u + v * v;
  T radial = T(1.0), du = T(0.0), dv = T(0.0);
  T fx = p[0], fy = p[0];
  const T* centre = p + 1;
  switch (model) {
    case CameraModel::kSimplePinhole:
      break;
    case CameraModel::kPinhole:
      fy = p[1];
      centre = p + 2;
      break;
    case CameraModel::kSimpleRadial:
      radial = T(1.0) + p[3] * r2;
      break;
    case CameraModel::kRadial:
      radial = T(1.0) + r2 * (p[3] + p[4] * r2);
      break;
    case CameraModel::kOpenCv:
    case CameraModel::kFullOpenCv: {
      fy = p[1];
      centre = p + 2;
      radial = T(1.0) + r2 * (p[4] + p[5] * r2);
      if (model == CameraModel::kFullOpenCv) {
        radial = (T(1.0) + r2 * (p[4] + r2 * (p[5] + r2 * p[8]))) /
                 (T(1.0) + r2 * (p[9] + r2 * (p[10] + r2 * p[11])));
      }
      du = T(2.0) * p[6] * u * v + p[7] * (r2 + T(2.0) * u * u);
      dv = T(2.0) * p[7] * u * v + p[6] * (r2 + T(2.0) * v * v);
      break;
    }
  }
  *x_px = fx * (u * radial + du) + centre[0];
  *y_px = fy * (v * radial + dv) + centre[1];
}

// Image point of a point in the camera frame; z must be positive.
Eigen::Vector2d ImageFromCamera(const Camera& camera, const Eigen::Vector3d& point_in_camera);

// Square of a pixel's distance from the principal point, in half diagonals of the picture.
double VignettingRadius2(const Camera& camera, const Eigen::Vector2d& point_px);
// Share of the light that reaches a pixel at that distance: 1 + v1·r² + v2·r⁴ + v3·r⁶, at least
// 0.05 so that dividing by it is safe.
double Vignetting(const Camera& camera, const Eigen::Vector2d& point_px);

// Normalised point (u, v) that projects to `point_px`, by Newton's iteration on the distortion.
// nullopt where the distortion has no inverse there (outside its monotone range).
std::optional<Eigen::Vector2d> NormalizedFromImage(const Camera& camera,
                                                   const Eigen::Vector2d& point_px);

// The same camera for an image resized by a factor (principal point and focal lengths scaled).
Camera ScaledCamera(const Camera& camera, double factor);

}  // namespace glint
