// COLMAP's camera models and parameter order (https://colmap.github.io/cameras.html), as values.
//
// Image coordinates: pixels, the centre of the top-left pixel is (0.5, 0.5), as in COLMAP.
// Camera frame: x right, y down, z forward. u = x/z, v = y/z; distortion acts on (u, v).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

enum class CameraModel {
  kSimplePinhole,
  kPinhole,
  kSimpleRadial,
  kRadial,
  kOpenCv,
  kFullOpenCv,
  kOpenCvFisheye,
  kSimpleRadialFisheye,
  kRadialFisheye
};

struct CameraParameter {
  // Along x, along y: two that follow each other are a vector in the picture's plane.
  enum Kind { kNone, kFocalLength, kPrincipalPoint, kRadial, kAlongX, kAlongY };
  std::string_view name;
  Kind kind = kNone;
  int power = 0;  // of a radial term: the power of r² (fisheye: of θ²) that it multiplies

  constexpr bool of_a_vector() const { return kind == kAlongX || kind == kAlongY; }
};

inline constexpr size_t kMostCameraParameters = 12;

// What glint-calib does with a model.
enum class Calibrated {
  kNo,        // read from elsewhere only
  kOnDemand,  // where --model names it
  kCompared   // and where models are compared by cross-validation
};

struct CameraModelInfo {
  CameraModel model;
  std::string_view name;  // COLMAP's
  // Focal lengths (one or two), the principal point, the lens's terms.
  std::array<CameraParameter, kMostCameraParameters> parameters;
  Calibrated calibrated = Calibrated::kNo;
  bool equidistant = false;  // distorts a ray's angle from the axis, not its tangent
};

namespace camera_parameter {
inline constexpr CameraParameter f{"f", CameraParameter::kFocalLength},
    fx{"fx", CameraParameter::kFocalLength}, fy{"fy", CameraParameter::kFocalLength},
    cx{"cx", CameraParameter::kPrincipalPoint}, cy{"cy", CameraParameter::kPrincipalPoint},
    p1{"p1", CameraParameter::kAlongY}, p2{"p2", CameraParameter::kAlongX};
constexpr CameraParameter Radial(std::string_view name, int power) {
  return {name, CameraParameter::kRadial, power};
}
}  // namespace camera_parameter

// The camera models, in the order of the enumeration. To add one: its enumerator above, its row
// here, and its distortion in Distorted() below.
inline constexpr auto kCameraModels = [] {
  using namespace camera_parameter;
  constexpr CameraParameter k = Radial("k", 1), k1 = Radial("k1", 1), k2 = Radial("k2", 2),
                            k3 = Radial("k3", 3), k4 = Radial("k4", 4);
  return std::to_array<CameraModelInfo>({
      {CameraModel::kSimplePinhole, "SIMPLE_PINHOLE", {f, cx, cy}},
      {CameraModel::kPinhole, "PINHOLE", {fx, fy, cx, cy}},
      {CameraModel::kSimpleRadial, "SIMPLE_RADIAL", {f, cx, cy, k}, Calibrated::kCompared},
      {CameraModel::kRadial, "RADIAL", {f, cx, cy, k1, k2}, Calibrated::kCompared},
      {CameraModel::kOpenCv, "OPENCV", {fx, fy, cx, cy, k1, k2, p1, p2}, Calibrated::kCompared},
      {CameraModel::kFullOpenCv,
       "FULL_OPENCV",
       {fx, fy, cx, cy, k1, k2, p1, p2, k3, Radial("k4", 1), Radial("k5", 2), Radial("k6", 3)},
       Calibrated::kCompared},
      {CameraModel::kOpenCvFisheye,
       "OPENCV_FISHEYE",
       {fx, fy, cx, cy, k1, k2, k3, k4},
       Calibrated::kOnDemand,
       true},
      {CameraModel::kSimpleRadialFisheye,
       "SIMPLE_RADIAL_FISHEYE",
       {f, cx, cy, k},
       Calibrated::kOnDemand,
       true},
      {CameraModel::kRadialFisheye,
       "RADIAL_FISHEYE",
       {f, cx, cy, k1, k2},
       Calibrated::kOnDemand,
       true},
  });
}();

constexpr const CameraModelInfo& InfoOf(CameraModel model) {
  return kCameraModels[static_cast<size_t>(model)];
}

// One or two: the first parameters. The principal point follows.
constexpr size_t FocalLengthCount(CameraModel model) {
  return InfoOf(model).parameters[1].kind == CameraParameter::kFocalLength ? 2 : 1;
}
// Whether the parameter at `i` is in pixels: a focal length or the principal point.
constexpr bool IsLength(CameraModel model, size_t i) { return i < FocalLengthCount(model) + 2; }
constexpr size_t PrincipalPointIndex(CameraModel model) { return FocalLengthCount(model); }

// COLMAP's name ("SIMPLE_RADIAL" …) and its inverse (nullopt: unknown name).
std::string_view CameraModelName(CameraModel model);
std::optional<CameraModel> CameraModelFromName(std::string_view name);

// Those that are at least `calibrated`, from the fewest parameters on; of as many, in the table's
// order.
std::vector<CameraModel> CalibratedModels(Calibrated calibrated);
// "SIMPLE_PINHOLE, PINHOLE …", all of them, for messages.
std::string CameraModelNamesText();

// Parameter names in order, for manifests, tables and covariances.
const std::vector<std::string>& CameraParameterNames(CameraModel model);

struct Camera {
  CameraModel model = CameraModel::kSimpleRadial;
  int width_px = 0;
  int height_px = 0;
  std::vector<double> parameters;
  // The lens's fall-off (v1, v2, v3), see Vignetting(); zeros: none, or not known.
  std::array<double, 3> vignetting{0, 0, 0};

  double focal_length_x() const { return parameters[0]; }
  double focal_length_y() const { return parameters[FocalLengthCount(model) - 1]; }
  Eigen::Vector2d principal_point_px() const {
    return Eigen::Vector2d::Map(&parameters[PrincipalPointIndex(model)]);
  }
};

// The normalised camera point (u, v) as the lens bends it: (*u_out, *v_out), still in focal
// lengths. `k`: the lens's terms, those after the principal point. T is double or a Jet.
template <class T>
void Distorted(CameraModel model, const T* k, const T& u, const T& v, T* u_out, T* v_out) {
  const T r2 = u * u + v * v;
  T radial = T(1.0), du = T(0.0), dv = T(0.0);
  const auto tangential = [&](const T& p1, const T& p2) {
    du = T(2.0) * p1 * u * v + p2 * (r2 + T(2.0) * u * u);
    dv = T(2.0) * p2 * u * v + p1 * (r2 + T(2.0) * v * v);
  };
  // The equidistant projection: a ray's angle θ from the axis, over its tangent r, times
  // `series`(θ²).
  const auto fisheye = [&](auto series) {
    using std::atan, std::sqrt;
    if (r2 <
        T(1e-8)) {  // θ² = r² and θ/r = 1 − r²/3 to the last digit, and r has no derivative at 0
      radial = (T(1.0) - r2 / T(3.0)) * series(r2);
      return;
    }
    const T r = sqrt(r2);
    const T theta = atan(r);
    radial = theta * series(theta * theta) / r;
  };
  switch (model) {
    case CameraModel::kSimplePinhole:
    case CameraModel::kPinhole:
      break;
    case CameraModel::kSimpleRadial:
      radial = T(1.0) + k[0] * r2;
      break;
    case CameraModel::kRadial:
      radial = T(1.0) + r2 * (k[0] + k[1] * r2);
      break;
    case CameraModel::kOpenCv:
      radial = T(1.0) + r2 * (k[0] + k[1] * r2);
      tangential(k[2], k[3]);
      break;
    case CameraModel::kFullOpenCv:
      radial = (T(1.0) + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) /
               (T(1.0) + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
      tangential(k[2], k[3]);
      break;
    case CameraModel::kOpenCvFisheye:
      fisheye([&](const T& t2) {
        return T(1.0) + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])));
      });
      break;
    case CameraModel::kSimpleRadialFisheye:
      fisheye([&](const T& t2) { return T(1.0) + t2 * k[0]; });
      break;
    case CameraModel::kRadialFisheye:
      fisheye([&](const T& t2) { return T(1.0) + t2 * (k[0] + t2 * k[1]); });
      break;
  }
  *u_out = u * radial + du;
  *v_out = v * radial + dv;
}

// Image point of the normalised camera point (u, v). T is double or a Jet; `p` are the parameters.
template <class T>
void ImageFromNormalized(CameraModel model, const T* p, const T& u, const T& v, T* x_px, T* y_px) {
  const size_t focal_lengths = FocalLengthCount(model);
  const T* centre = p + focal_lengths;
  T bent_u, bent_v;
  Distorted(model, centre + 2, u, v, &bent_u, &bent_v);
  *x_px = p[0] * bent_u + centre[0];
  *y_px = p[focal_lengths - 1] * bent_v + centre[1];
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
