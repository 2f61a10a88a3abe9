#include "base/camera/camera_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace glint {
namespace {

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

std::string_view CameraModelName(CameraModel model) { return InfoOf(model).name; }

std::optional<CameraModel> CameraModelFromName(std::string_view name) {
  for (const CameraModelInfo& info : kCameraModels) {
    if (info.name == name) return info.model;
  }
  return std::nullopt;
}

std::vector<CameraModel> CalibratedModels(Calibrated calibrated) {
  std::vector<CameraModel> chosen;
  for (const CameraModelInfo& info : kCameraModels) {
    if (info.calibrated >= calibrated) chosen.push_back(info.model);
  }
  std::stable_sort(chosen.begin(), chosen.end(), [](CameraModel a, CameraModel b) {
    return CameraParameterNames(a).size() < CameraParameterNames(b).size();
  });
  return chosen;
}

std::string CameraModelNamesText() {
  std::string text;
  for (const CameraModelInfo& info : kCameraModels) {
    text += (text.empty() ? "" : ", ") + std::string(info.name);
  }
  return text;
}

const std::vector<std::string>& CameraParameterNames(CameraModel model) {
  static const auto names = [] {
    std::array<std::vector<std::string>, kCameraModels.size()> all;
    for (size_t i = 0; i < all.size(); ++i) {
      for (const CameraParameter& parameter : kCameraModels[i].parameters) {
        if (parameter.kind != CameraParameter::kNone) all[i].emplace_back(parameter.name);
      }
    }
    return all;
  }();
  return names[static_cast<size_t>(model)];
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
  const Eigen::Vector2d from_centre_px = point_px - camera.principal_point_px();
  Eigen::Vector2d uv(from_centre_px.x() / camera.focal_length_x(),
                     from_centre_px.y() / camera.focal_length_y());
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
  return (point_px - camera.principal_point_px()).squaredNorm() / half.squaredNorm();
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
  const size_t lengths_px = PrincipalPointIndex(camera.model) + 2;
  for (size_t i = 0; i < lengths_px; ++i) scaled.parameters[i] *= factor;
  return scaled;
}

}  // namespace glint
