#include "calib/validation/scatter.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib/uncertainty/implied_motion.h"
#include "calib/uncertainty/projection_jacobian.h"
#include "calib/uncertainty/projection_uncertainty.h"
#include "calib/uncertainty/sample_uncertainty.h"
#include "calib/validation/cross_validation.h"

namespace glint {
namespace {

// splitmix64 and Box and Muller: the same on every machine, unlike <random>'s distributions.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  double Normal() {
    const double u = 1 - Uniform(), v = Uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
  }

 private:
  double Uniform() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  std::uint64_t state_;
};

// Sums of squared deviations and of predicted variances.
struct Sum {
  double squares = 0, variances = 0;
  int count = 0;
  void Add(double square, double variance, int n = 1) {
    squares += square;
    variances += variance;
    count += n;
  }
  ScatterLine Line(const std::string& quantity) const {
    const double n = std::max(1, count);
    return {quantity, std::sqrt(squares / n), std::sqrt(variances / n)};
  }
};

// Corners where the truth predicts them.
BundleProblem Predicted(const BundleProblem& problem, const BundleResult& truth) {
  BundleProblem out = problem;
  for (size_t i = 0; i < problem.photos.size(); ++i) {
    auto& corners = out.photos[i].corners;
    corners.clear();
    if (!truth.photos[i].rejected.empty()) continue;
    for (size_t k = 0; k < problem.photos[i].corners.size(); ++k) {
      const CornerResidual& corner = truth.photos[i].corners[k];
      if (!corner.inlier) continue;
      corners.push_back(problem.photos[i].corners[k]);
      corners.back().point_px -= corner.residual_px;
    }
  }
  return out;
}

BundleProblem Noisy(BundleProblem problem, double noise_px, Noise* noise) {
  for (BundlePhoto& photo : problem.photos) {
    for (BundleCorner& corner : photo.corners) {
      corner.point_px.x() += noise_px * noise->Normal();
      corner.point_px.y() += noise_px * noise->Normal();
    }
  }
  return problem;
}

// The lens can be undone over the whole picture.
bool IsUsable(const Camera& camera) {
  for (const Eigen::Vector2d& at : GridOver(camera, 12).points_px) {
    const auto ray = NormalizedFromImage(camera, at);
    if (!ray || (ImageFromCamera(camera, ray->homogeneous()) - at).norm() > 1e-3) return false;
  }
  return true;
}

// Camera 0 as it may be after all that `truth` knows.
Camera DrawnCamera(const CameraEstimate& estimate, Noise* noise) {
  constexpr int kTries = 100;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(estimate.covariance);
  for (int attempt = 0; attempt < kTries; ++attempt) {
    Eigen::VectorXd step = modes.eigenvalues().cwiseMax(0).cwiseSqrt();
    for (double& value : step) value *= noise->Normal();
    const Eigen::VectorXd moved = modes.eigenvectors() * step;
    Camera camera = estimate.camera;
    for (size_t i = 0; i < camera.parameters.size(); ++i) {
      camera.parameters[i] += moved[static_cast<Eigen::Index>(i)];
    }
    if (IsUsable(camera)) return camera;
  }
  return estimate.camera;
}

// The corners of camera 0's photos as `camera` would have seen them.
BundleProblem SeenBy(const Camera& camera, const BundleResult& truth, BundleProblem problem) {
  for (size_t i = 0; i < problem.photos.size(); ++i) {
    if (problem.photos[i].camera != 0) continue;
    const Rigid3& pose = truth.photos[i].camera_from_sample;
    for (BundleCorner& corner : problem.photos[i].corners) {
      const Eigen::Vector2d& place = corner.position_in_sample_mm;
      const Eigen::Vector3d point = pose * Eigen::Vector3d(place.x(), place.y(), 0);
      corner.point_px +=
          ImageFromCamera(camera, point) - ImageFromCamera(truth.cameras[0].camera, point);
    }
  }
  return problem;
}

class Comparison {
 public:
  Comparison(BundleResult truth, const Eigen::Vector2d& sample_size_mm)
      : truth_(std::move(truth)), sample_size_mm_(sample_size_mm), points_(SeenPoints(truth_, 0)) {
    intrinsics_.resize(truth_.cameras[0].camera.parameters.size());
    grid_ = GridOver(truth_.cameras[0].camera, 12);
    depth_mm_ = ProjectionUncertainty(truth_.cameras[0], points_).median_depth_mm();
  }

  // The truth of the draws to come.
  void SetTrueCamera(const Camera& camera) { truth_.cameras[0].camera = camera; }

  void Add(const BundleResult& draw) {
    const CameraEstimate& camera = draw.cameras[0];
    for (size_t i = 0; i < intrinsics_.size(); ++i) {
      const double deviation = camera.camera.parameters[i] - truth_.cameras[0].camera.parameters[i];
      intrinsics_[i].Add(deviation * deviation, camera.sigma[i] * camera.sigma[i]);
    }
    if (draw.bend) {
      const Eigen::Vector2d true_height =
          truth_.bend ? truth_.bend->height_mm : Eigen::Vector2d(0, 0);
      bend_.Add((draw.bend->height_mm - true_height).squaredNorm(), draw.bend->covariance.trace(),
                2);
    }
    AddPoses(draw);
    AddProjections(camera);
    AddPlaces(draw);
  }

  Scatter Summary(int draws) const {
    Scatter scatter;
    scatter.draws = draws;
    const auto& names = CameraParameterNames(truth_.cameras[0].camera.model);
    for (size_t i = 0; i < intrinsics_.size(); ++i) {
      if (intrinsics_[i].variances > 0) scatter.intrinsics.push_back(intrinsics_[i].Line(names[i]));
    }
    scatter.rotation = rotation_.Line("rotation, degrees");
    scatter.position = position_.Line("position, mm");
    scatter.bend = bend_.Line("bend, mm");
    scatter.projections = {centre_.Line("projection, middle third, px"),
                           whole_.Line("projection, whole image, px")};
    scatter.sample = place_.Line("place on the sample, mm");
    return scatter;
  }

 private:
  void AddPoses(const BundleResult& draw) {
    for (size_t i = 0; i < draw.photos.size(); ++i) {
      const PhotoEstimate &now = draw.photos[i], &then = truth_.photos[i];
      if (now.camera != 0 || !now.rejected.empty() || !then.rejected.empty()) continue;
      const Eigen::AngleAxisd turn(now.camera_from_sample.rotation *
                                   then.camera_from_sample.rotation.transpose());
      const double degrees = turn.angle() * 180 / std::numbers::pi;
      rotation_.Add(degrees * degrees, 3 * now.sigma_rotation_deg * now.sigma_rotation_deg, 3);
      const Eigen::Vector3d shift = Inverse(now.camera_from_sample).translation -
                                    Inverse(then.camera_from_sample).translation;
      position_.Add(shift.squaredNorm(), 3 * now.sigma_position_mm * now.sigma_position_mm, 3);
    }
  }

  void AddProjections(const CameraEstimate& camera) {
    const Camera& from = truth_.cameras[0].camera;
    const Rigid3 motion = AlignCameras(from, camera.camera, points_);
    const ProjectionUncertainty uncertainty(camera, points_);
    for (const Eigen::Vector2d& at : grid_.points_px) {
      const auto point = PointSeenAt(from, at, depth_mm_);
      if (!point || !((motion * *point).z() > 1e-9)) continue;
      const double square = (ImageFromCamera(camera.camera, motion * *point) - at).squaredNorm();
      const double variance = uncertainty.At(*point).trace();
      whole_.Add(square, variance, 2);
      const bool middle = std::abs(at.x() / from.width_px - 0.5) < 1.0 / 6 &&
                          std::abs(at.y() / from.height_px - 0.5) < 1.0 / 6;
      if (middle) centre_.Add(square, variance, 2);
    }
  }

  // A pixel that truly shows a place on the sample is attributed to another place.
  void AddPlaces(const BundleResult& draw) {
    for (size_t i = 0; i < draw.photos.size(); ++i) {
      const PhotoEstimate &now = draw.photos[i], &then = truth_.photos[i];
      if (now.camera != 0 || !now.rejected.empty() || !then.rejected.empty()) continue;
      for (int k = 0; k < 9; ++k) {
        const Eigen::Vector2d place =
            Eigen::Vector2d(k % 3 * 0.5 - 0.5, k / 3 * 0.5 - 0.5).cwiseProduct(sample_size_mm_);
        const Eigen::Vector3d seen =
            then.camera_from_sample * Eigen::Vector3d(place.x(), place.y(), 0);
        const auto covariance = PlaceCovariance(draw, i, place);
        const auto ray = NormalizedFromImage(draw.cameras[0].camera,
                                             ImageFromCamera(truth_.cameras[0].camera, seen));
        if (!covariance || !ray) continue;
        const Rigid3 sample_from_camera = Inverse(now.camera_from_sample);
        const Eigen::Vector3d direction = sample_from_camera.rotation * ray->homogeneous();
        const Eigen::Vector3d& origin = sample_from_camera.translation;
        const Eigen::Vector3d hit = origin - direction * (origin.z() / direction.z());
        place_.Add((hit.head<2>() - place).squaredNorm(), covariance->trace(), 2);
      }
    }
  }

  BundleResult truth_;
  Eigen::Vector2d sample_size_mm_;
  std::vector<Eigen::Vector3d> points_;
  ImageGrid grid_;
  double depth_mm_ = 0;
  std::vector<Sum> intrinsics_;
  Sum rotation_, position_, bend_, centre_, whole_, place_;
};

}  // namespace

Scatter MeasureScatter(const BundleProblem& problem, const BundleResult& truth,
                       const BundleOptions& options, const Eigen::Vector2d& sample_size_mm,
                       double noise_px, int draws, std::uint64_t seed, bool draw_camera) {
  BundleOptions plain = options;
  plain.reject = false;
  const BundleProblem perfect = Predicted(problem, truth);
  Comparison comparison(truth, sample_size_mm);
  for (int draw = 0; draw < draws; ++draw) {
    Noise noise(seed * 1000003 + static_cast<std::uint64_t>(draw));
    BundleProblem seen = perfect;
    if (draw_camera) {
      const Camera camera = DrawnCamera(truth.cameras[0], &noise);
      comparison.SetTrueCamera(camera);
      seen = SeenBy(camera, truth, seen);
    }
    comparison.Add(AdjustBundle(Noisy(std::move(seen), noise_px, &noise), plain));
  }
  return comparison.Summary(draws);
}

std::string Scatter::Text() const {
  std::string text = fmt::format("{:<30} {:>12} {:>12} {:>7}\n", fmt::format("{} draws", draws),
                                 "scatter", "predicted", "ratio");
  const auto line = [&](const ScatterLine& l) {
    if (l.predicted == 0) return;
    text += fmt::format("{:<30} {:>12.4g} {:>12.4g} {:>7.3f}\n", l.quantity, l.scatter, l.predicted,
                        l.ratio());
  };
  for (const ScatterLine& l : intrinsics) line(l);
  for (const ScatterLine& l : {rotation, position, bend, projections[0], projections[1], sample}) {
    line(l);
  }
  return text;
}

}  // namespace glint
