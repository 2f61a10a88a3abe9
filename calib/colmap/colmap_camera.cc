#include "calib/colmap/colmap_camera.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/errors/errors.h"

namespace glint {
namespace {

using Eigen::Vector2d;

// COLMAP's numbers of the models that Glint does not have.
enum Foreign { kFov = 7, kThinPrism = 10 };

constexpr std::array<ColmapModelInfo, 11> kModels = {{{"SIMPLE_PINHOLE", 3, 1},
                                                      {"PINHOLE", 4, 2},
                                                      {"SIMPLE_RADIAL", 4, 1},
                                                      {"RADIAL", 5, 1},
                                                      {"OPENCV", 8, 2},
                                                      {"OPENCV_FISHEYE", 8, 2},
                                                      {"FULL_OPENCV", 12, 2},
                                                      {"FOV", 5, 2},
                                                      {"SIMPLE_RADIAL_FISHEYE", 4, 1},
                                                      {"RADIAL_FISHEYE", 5, 1},
                                                      {"THIN_PRISM_FISHEYE", 12, 2}}};

constexpr int kGrid = 25;  // points a side of the picture
constexpr double kWidestRay = 80 * std::numbers::pi / 180;

// FOV's distance from the centre, over the ray's, in focal lengths.
double FovScale(double omega, double radius) {
  if (std::abs(omega) < 1e-6) return 1;
  if (radius < 1e-9) return 2 * std::tan(omega / 2) / omega;
  return std::atan(radius * 2 * std::tan(omega / 2)) / (radius * omega);
}

// The equidistant projection with OpenCV's and thin-prism terms: k1 k2 p1 p2 k3 k4 sx1 sy1.
Vector2d ThinPrism(const double* e, double u, double v) {
  const double radius = std::hypot(u, v);
  const double scale = radius < 1e-9 ? 1 : std::atan(radius) / radius;
  const double a = u * scale, b = v * scale, r2 = a * a + b * b;
  const double radial = r2 * (e[0] + r2 * (e[1] + r2 * (e[4] + r2 * e[5])));
  return {a + a * radial + 2 * e[2] * a * b + e[3] * (r2 + 2 * a * a) + e[6] * r2,
          b + b * radial + 2 * e[3] * a * b + e[2] * (r2 + 2 * b * b) + e[7] * r2};
}

// A ray by its angle from the axis: (θ cos φ, θ sin φ). Fisheye models are nearly linear in it.
Vector2d DirectionOf(const Vector2d& angle) {
  const double theta = angle.norm();
  return theta < 1e-12 ? angle : Vector2d(angle * (std::tan(theta) / theta));
}

Vector2d PointAtAngle(const ColmapCamera& camera, const Vector2d& angle) {
  const Vector2d uv = DirectionOf(angle);
  return ColmapImagePoint(camera.model, camera.parameters, uv.x(), uv.y());
}

// The ray that is seen at `point_px`, by Newton's iteration; nullopt: none within kWidestRay.
std::optional<Vector2d> AngleOf(const ColmapCamera& camera, const Vector2d& point_px) {
  constexpr double kStep = 1e-6;
  const size_t focal_lengths = kModels[camera.model].focal_lengths;
  const double fx = camera.parameters[0], fy = camera.parameters[focal_lengths - 1];
  const Vector2d centre(camera.parameters[focal_lengths], camera.parameters[focal_lengths + 1]);
  Vector2d angle = (point_px - centre).cwiseQuotient(Vector2d(fx, fy));
  if (angle.norm() > kWidestRay) angle *= kWidestRay / angle.norm();
  for (int i = 0; i < 50; ++i) {
    const Vector2d residual = PointAtAngle(camera, angle) - point_px;
    if (residual.norm() < 1e-9 * fx) return angle;
    Eigen::Matrix2d jacobian;
    for (int k = 0; k < 2; ++k) {
      const Vector2d step = kStep * Vector2d::Unit(k);
      jacobian.col(k) =
          (PointAtAngle(camera, angle + step) - PointAtAngle(camera, angle - step)) / (2 * kStep);
    }
    angle -= jacobian.inverse() * residual;
    if (!angle.allFinite() || angle.norm() > 1.1 * kWidestRay) return std::nullopt;
  }
  return std::nullopt;
}

struct Ray {
  Vector2d uv, point_px;
};

// FULL_OPENCV's twelve parameters against one ray.
struct LensError {
  Ray ray;
  template <class T>
  bool operator()(const T* lens, T* residual) const {
    T x, y;
    ImageFromNormalized(CameraModel::kFullOpenCv, lens, T(ray.uv.x()), T(ray.uv.y()), &x, &y);
    residual[0] = x - T(ray.point_px.x());
    residual[1] = y - T(ray.point_px.y());
    return true;
  }
};

[[noreturn]] void Refuse(const std::filesystem::path& file, const ColmapCamera& camera,
                         const std::string& found) {
  throw UserError(file, fmt::format("camera {} ({})", camera.id, kModels[camera.model].name), found,
                  "Glint's cameras are perspective: crop or undistort the photographs (colmap "
                  "image_undistorter), or calibrate them as OPENCV or FULL_OPENCV");
}

std::vector<Ray> GridRays(const std::filesystem::path& file, const ColmapCamera& camera) {
  std::vector<Ray> rays;
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const Vector2d share(static_cast<double>(i % kGrid) / (kGrid - 1),
                         static_cast<double>(i / kGrid) / (kGrid - 1));
    const Vector2d point_px(share.x() * camera.width_px, share.y() * camera.height_px);
    const auto angle = AngleOf(camera, point_px);
    if (!angle || angle->norm() > kWidestRay) {
      Refuse(file, camera,
             fmt::format("no ray within {:.0f} degrees of the axis for the pixel ({:.0f}, {:.0f})",
                         kWidestRay * 180 / std::numbers::pi, point_px.x(), point_px.y()));
    }
    rays.push_back({DirectionOf(*angle), point_px});
  }
  return rays;
}

// FOV's focal length is not the scale at the centre, which the others' is.
std::array<double, 4> LensOf(const ColmapCamera& camera) {
  const auto& p = camera.parameters;
  const size_t n = kModels[camera.model].focal_lengths;
  const double scale = camera.model == kFov ? FovScale(p[4], 0) : 1;
  return {p[0] * scale, p[n - 1] * scale, p[n], p[n + 1]};
}

Camera FitLens(const ColmapCamera& camera, const std::vector<Ray>& rays) {
  const std::array<double, 4> start = LensOf(camera);
  std::array<double, 12> lens{};
  std::copy(start.begin(), start.end(), lens.begin());
  ceres::Problem problem;
  for (const Ray& ray : rays) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<LensError, 2, 12>(new LensError{ray}),
                             nullptr, lens.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.max_num_iterations = 500;
  options.function_tolerance = options.parameter_tolerance = 1e-14;
  options.gradient_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return {CameraModel::kFullOpenCv,
          static_cast<int>(camera.width_px),
          static_cast<int>(camera.height_px),
          {lens.begin(), lens.end()}};
}

}  // namespace

std::span<const ColmapModelInfo> ColmapModels() { return kModels; }

std::optional<int> ColmapModelFromName(std::string_view name) {
  for (size_t i = 0; i < kModels.size(); ++i) {
    if (kModels[i].name == name) return static_cast<int>(i);
  }
  return std::nullopt;
}

Vector2d ColmapImagePoint(int model, std::span<const double> parameters, double u, double v) {
  const ColmapModelInfo& info = kModels[model];
  if (const auto own = CameraModelFromName(info.name)) {
    Vector2d point;
    ImageFromNormalized(*own, parameters.data(), u, v, &point.x(), &point.y());
    return point;
  }
  const size_t n = info.focal_lengths;
  const double* extra = parameters.data() + n + 2;
  const Vector2d bent = model == kThinPrism
                            ? ThinPrism(extra, u, v)
                            : Vector2d(Vector2d(u, v) * FovScale(extra[0], std::hypot(u, v)));
  return {parameters[0] * bent.x() + parameters[n],
          parameters[n - 1] * bent.y() + parameters[n + 1]};
}

ConvertedCamera ConvertCamera(const std::filesystem::path& file, const ColmapCamera& camera) {
  ConvertedCamera converted;
  if (const auto own = CameraModelFromName(kModels[camera.model].name)) {
    converted.camera = {*own, static_cast<int>(camera.width_px), static_cast<int>(camera.height_px),
                        camera.parameters};
    if (InfoOf(*own).equidistant) GridRays(file, camera);  // which refuses rays beyond kWidestRay
    return converted;
  }
  const std::vector<Ray> rays = GridRays(file, camera);
  converted.exact = false;
  converted.camera = FitLens(camera, rays);
  for (const Ray& ray : rays) {
    const double error_px =
        (ImageFromCamera(converted.camera, ray.uv.homogeneous()) - ray.point_px).norm();
    // What follows goes from pixels to rays too: there the fit must hold as well.
    const auto back = NormalizedFromImage(converted.camera, ray.point_px);
    if (!back || !(error_px <= kLargestConversion_px)) {
      Refuse(file, camera,
             fmt::format("a lens that no perspective camera model fits (off by {:.2f} pixels)",
                         error_px));
    }
    converted.rms_px += error_px * error_px / rays.size();
    converted.largest_px = std::max(converted.largest_px, error_px);
  }
  converted.rms_px = std::sqrt(converted.rms_px);
  return converted;
}

ColmapCamera ToColmapCamera(const Camera& camera, std::uint32_t id) {
  return {id, *ColmapModelFromName(CameraModelName(camera.model)),
          static_cast<std::uint64_t>(camera.width_px), static_cast<std::uint64_t>(camera.height_px),
          camera.parameters};
}

}  // namespace glint
