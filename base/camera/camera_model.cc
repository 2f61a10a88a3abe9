#include "base/camera/camera_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace glint {
namespace {

struct ModelInfo {
  CameraModel model;
  std::string_view name;
  std::vector<std::string> parameters;
  bool calibrated = false;  // offered by glint-calib
};

// In the order of the enumeration.
const std::vector<ModelInfo>& Models() {
  static const std::vector<ModelInfo> models = {
      {CameraModel::kSimplePinhole, "SIMPLE_PINHOLE", {"f", "cx", "cy"}},
      {CameraModel::kPinhole, "PINHOLE", {"fx", "fy", "cx", "cy"}},
      {CameraModel::kSimpleRadial, "SIMPLE_RADIAL", {"f", "cx", "cy", "k"}, true},
      {CameraModel::kRadial, "RADIAL", {"f", "cx", "cy", "k1", "k2"}, true},
      {CameraModel::kOpenCv, "OPENCV", {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"}, true},
      {CameraModel::kFullOpenCv,
       "FULL_OPENCV",
       {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"},
       true},
  };
  return models;
}

// Distorted minus wanted point in normalised units (focal length divided out), and its Jacobian.
Eigen::Vector2d Residual(const Camera& camera, const Eigen::Vector2d& uv,
                         const Eigen::Vector2d& wanted_px) {
  Eigen::Vector2d image;
  ImageFromNormalized(camera.model, camera.parameters.data(), uv.x(), uv.y(), &image.x(),
                      &image.y());
  return {(image.x() - wanted_px.x()) / camera.focal_length_x(),
          (image.y() - wanted_px.y()) / camera.focal_length_y()};
}

}  // namespace

std::string_view CameraModelName(CameraModel model) {
  return Models()[static_cast<size_t>(model)].name;
}

std::optional<CameraModel> CameraModelFromName(std::string_view name) {
  for (const ModelInfo& info : Models()) {
    if (info.name == name) return info.model;
  }
  return std::nullopt;
}

const std::vector<CameraModel>& CalibratedModels() {
  static const std::vector<CameraModel> models = [] {
    std::vector<CameraModel> chosen;
    for (const ModelInfo& info : Models()) {
      if (info.calibrated) chosen.push_back(info.model);
    }
    std::stable_sort(chosen.begin(), chosen.end(), [](CameraModel a, CameraModel b) {
      return CameraParameterNames(a).size() < CameraParameterNames(b).size();
    });
    return chosen;
  }();
  return models;
}

std::string CameraModelNamesText() {
  std::string text;
  for (const ModelInfo& info : Models())
    text += (text.empty() ? "" : ", ") + std::string(info.name);
  return text;
}

const std::vector<std::string>& CameraParameterNames(CameraModel model) {
  return Models()[static_cast<size_t>(model)].parameters;
}

double Camera::focal_length_y() const {
  return CameraParameterNames(model)[0] == "fx" ? parameters[1] : parameters[0];
}

Eigen::Vector2d ImageFromCamera(const Camera& camera, const Eigen::Vector3d& point_in_camera) {
  const double u = point_in_camera.x() / point_in_camera.z();
  const double v = point_in_camera.y() / point_in_camera.z();
  Eigen::Vector2d image;
  ImageFromNormalized(camera.model, camera.parameters.data(), u, v, &image.x(), &image.y());
  return image;
}

std::optional<Eigen::Vector2d> NormalizedFromImage(const Camera& camera,
                                                   const Eigen::Vector2d& point_px) {
  constexpr int kMaxIterations = 50;
  constexpr double kStep = 1e-6;  // central differences: exact to ~1e-12 for these polynomials
  const bool one_focal = camera.focal_length_y() == camera.parameters[0] &&
                         CameraParameterNames(camera.model)[0] == "f";
  const double cx = camera.parameters[one_focal ? 1 : 2];
  const double cy = camera.parameters[one_focal ? 2 : 3];
  Eigen::Vector2d uv((point_px.x() - cx) / camera.focal_length_x(),
                     (point_px.y() - cy) / camera.focal_length_y());
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::Vector2d residual = Residual(camera, uv, point_px);
    if (!residual.allFinite()) return std::nullopt;
    if (residual.norm() < 1e-13) break;
    Eigen::Matrix2d jacobian;
    for (int k = 0; k < 2; ++k) {
      Eigen::Vector2d step = Eigen::Vector2d::Zero();
      step[k] = kStep;
      jacobian.col(k) =
          (Residual(camera, uv + step, point_px) - Residual(camera, uv - step, point_px)) /
          (2 * kStep);
    }
    if (jacobian.determinant() <= 1e-6) return std::nullopt;
    uv -= jacobian.inverse() * residual;
  }
  if (Residual(camera, uv, point_px).norm() > 1e-9) return std::nullopt;
  return uv;
}

double VignettingRadius2(const Camera& camera, const Eigen::Vector2d& point_px) {
  const Eigen::Vector2d half(0.5 * camera.width_px, 0.5 * camera.height_px);
  const size_t centre = CameraParameterNames(camera.model)[0] == "f" ? 1 : 2;
  const Eigen::Vector2d axis_px(camera.parameters[centre], camera.parameters[centre + 1]);
  return (point_px - axis_px).squaredNorm() / half.squaredNorm();
}

double Vignetting(const Camera& camera, const Eigen::Vector2d& point_px) {
  constexpr double kLeast = 0.05;
  const auto& v = camera.vignetting;
  const double r2 = VignettingRadius2(camera, point_px);
  return std::max(kLeast, 1 + r2 * (v[0] + r2 * (v[1] + r2 * v[2])));
}

Camera ScaledCamera(const Camera& camera, double factor) {
  Camera scaled = camera;
  scaled.width_px = static_cast<int>(std::lround(camera.width_px * factor));
  scaled.height_px = static_cast<int>(std::lround(camera.height_px * factor));
  const size_t lengths = CameraParameterNames(camera.model)[0] == "f" ? 3 : 4;
  for (size_t i = 0; i < lengths; ++i) scaled.parameters[i] *= factor;
  return scaled;
}

}  // namespace glint
