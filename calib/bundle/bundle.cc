#include "calib/bundle/bundle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors/errors.h"
#include "calib/bundle/bundle_internal.h"

namespace glint {
namespace {

using bundle::PhotoState;
using bundle::State;

void CheckOptions(const BundleOptions& options) {
  const auto& names = CameraParameterNames(options.model);
  for (const std::string& name : options.hold) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end() ||
        IsLength(options.model, static_cast<size_t>(found - names.begin()))) {
      throw UserError(fmt::format(
          "option hold: found \"{}\"; name distortion parameters of {}: its parameters are {}",
          name, CameraModelName(options.model), fmt::join(names, ", ")));
    }
  }
}

void RejectSmallPhotos(const BundleProblem& problem, const BundleOptions& options, State* state) {
  for (size_t i = 0; i < problem.photos.size(); ++i) {
    PhotoState& photo = state->photos[i];
    const int corners = static_cast<int>(problem.photos[i].corners.size());
    if (!photo.accepted || corners >= options.min_corners) continue;
    photo.accepted = false;
    photo.rejected = fmt::format("{} corners; {} are needed", corners, options.min_corners);
  }
}

void RequirePhotos(const BundleProblem& problem, const State& state) {
  std::string reasons;
  for (size_t i = 0; i < problem.photos.size(); ++i) {
    if (state.photos[i].accepted) return;
    reasons += "\n  " + problem.photos[i].name + ": " + state.photos[i].rejected;
  }
  throw ComputationError("no photograph can be used for the calibration:" + reasons);
}

double TiltDegrees(const Rigid3& camera_from_sample) {
  return std::acos(std::min(1.0, std::abs(camera_from_sample.rotation(2, 2)))) * 180 /
         std::numbers::pi;
}

// Solves and rejects until the set of outliers stays the same.
int Iterate(const BundleProblem& problem, const BundleOptions& options, State* state) {
  constexpr int kMaxRounds = 12;
  double sigma = std::max(1.0, bundle::RobustSigma(problem, *state));
  bundle::Solve(problem, options, bundle::Refine::kFocalAndPoses, 2 * sigma, sigma, state);
  sigma = std::max(0.5, bundle::RobustSigma(problem, *state));
  bundle::Solve(problem, options, bundle::Refine::kAll, 2 * sigma, sigma, state);
  int rounds = 0;
  for (bool changed = options.reject; changed && rounds < kMaxRounds; ++rounds) {
    sigma = bundle::RobustSigma(problem, *state);
    bundle::Solve(problem, options, bundle::Refine::kAll, std::max(2 * sigma, 1e-3), sigma, state);
    changed = bundle::Reject(problem, options, bundle::RobustSigma(problem, *state), state);
    RequirePhotos(problem, *state);
  }
  bundle::Solve(problem, options, bundle::Refine::kAll, 0, bundle::RobustSigma(problem, *state),
                state);
  return rounds;
}

BundleResult Summarise(const BundleProblem& problem, const BundleOptions& options,
                       const State& state) {
  BundleResult result;
  if (problem.bend || options.bend) result.bend = state.bend;
  for (const Camera& camera : state.cameras) result.cameras.push_back({camera, {}, {}, 0});
  double sum = 0;
  for (size_t i = 0; i < problem.photos.size(); ++i) {
    const BundlePhoto& photo = problem.photos[i];
    const PhotoState& photo_state = state.photos[i];
    PhotoEstimate estimate;
    estimate.name = photo.name;
    estimate.camera = photo.camera;
    estimate.rejected = photo_state.rejected;
    estimate.camera_from_sample = photo_state.camera_from_sample();
    estimate.tilt_deg = TiltDegrees(estimate.camera_from_sample);
    double photo_sum = 0;
    const auto residuals = bundle::Residuals(photo, state, photo_state);
    for (size_t k = 0; k < photo.corners.size(); ++k) {
      const bool inlier = photo_state.inlier[k];
      estimate.corners.push_back({photo.corners[k].id, photo.corners[k].point_px, residuals[k],
                                  inlier, photo.corners[k].position_in_sample_mm});
      if (inlier) photo_sum += residuals[k].squaredNorm();
    }
    estimate.rms_px = std::sqrt(photo_sum / std::max(1, estimate.inliers()));
    if (photo_state.accepted) {
      ++result.cameras[photo.camera].photos;
      result.corners += static_cast<int>(photo.corners.size());
      result.inliers += estimate.inliers();
      sum += photo_sum;
    }
    result.photos.push_back(std::move(estimate));
  }
  result.rms_px = std::sqrt(sum / std::max(1, result.inliers));
  return result;
}

std::string TiltRange(const BundleResult& result, int camera, double* largest) {
  double smallest = 90;
  *largest = 0;
  for (const PhotoEstimate& photo : result.photos) {
    if (photo.camera != camera || !photo.rejected.empty()) continue;
    smallest = std::min(smallest, photo.tilt_deg);
    *largest = std::max(*largest, photo.tilt_deg);
  }
  return fmt::format("{:.1f} to {:.1f} degrees", smallest, *largest);
}

// Photos that all look straight down at the board fix the ratio of focal length and distance only.
void RequireFocalLengths(const BundleResult& result, const std::vector<double>& focal_sigmas,
                         const BundleOptions& options) {
  for (size_t c = 0; c < focal_sigmas.size(); ++c) {
    if (result.cameras[c].photos == 0 || focal_sigmas[c] <= options.max_focal_sigma) continue;
    double largest = 0;
    const std::string tilts = TiltRange(result, static_cast<int>(c), &largest);
    const std::string uncertain =
        std::isfinite(focal_sigmas[c])
            ? fmt::format("uncertain by {:.0f} %", std::min(999.0, 100 * focal_sigmas[c]))
            : std::string("undetermined");
    throw UserError(fmt::format(
        "photos: found {} with the board tilted by {}, which leaves the focal length {}; tilt "
        "the phone by 20 to 40 degrees, in several directions, or give the intrinsics "
        "(fix-intrinsics)",
        result.cameras[c].photos == 1 ? std::string("one photograph")
                                      : fmt::format("{} photographs", result.cameras[c].photos),
        tilts, uncertain));
  }
}

}  // namespace

Eigen::Vector3d BoardPoint(const std::optional<BoardBend>& bend,
                           const Eigen::Vector2d& position_in_sample_mm) {
  return {position_in_sample_mm.x(), position_in_sample_mm.y(),
          bend ? bend->HeightAt(position_in_sample_mm) : 0};
}

int PhotoEstimate::inliers() const {
  return static_cast<int>(std::count_if(corners.begin(), corners.end(),
                                        [](const CornerResidual& c) { return c.inlier; }));
}

std::string BundleResult::BriefReport() const {
  const auto accepted = std::count_if(photos.begin(), photos.end(),
                                      [](const PhotoEstimate& p) { return p.rejected.empty(); });
  std::string text =
      fmt::format("{} of {} photos, {} of {} corners, reprojection error {:.3f} px RMS\n", accepted,
                  photos.size(), inliers, corners, rms_px);
  for (size_t c = 0; c < cameras.size(); ++c) {
    const CameraEstimate& estimate = cameras[c];
    if (estimate.photos == 0) continue;
    text +=
        fmt::format("camera {}: {} {}x{}, {} photos\n", c, CameraModelName(estimate.camera.model),
                    estimate.camera.width_px, estimate.camera.height_px, estimate.photos);
    const auto& names = CameraParameterNames(estimate.camera.model);
    for (size_t i = 0; i < names.size(); ++i) {
      const bool length = IsLength(estimate.camera.model, i);
      const double value = estimate.camera.parameters[i];
      text += estimate.sigma[i] == 0 ? fmt::format("  {:<3} {:>12.6g}  fixed\n", names[i], value)
              : length
                  ? fmt::format("  {:<3} {:>12.3f} ± {:.3f}\n", names[i], value, estimate.sigma[i])
                  : fmt::format("  {:<3} {:>12.6f} ± {:.6f}\n", names[i], value, estimate.sigma[i]);
    }
  }
  if (bend) {
    text += fmt::format(
        "board: rises by {:.3f} ± {:.3f} mm across its width, {:.3f} ± {:.3f} mm "
        "across its height\n",
        bend->height_mm.x(), std::sqrt(bend->covariance(0, 0)), bend->height_mm.y(),
        std::sqrt(bend->covariance(1, 1)));
  }
  return text;
}

BundleResult AdjustBundle(const BundleProblem& problem, const BundleOptions& options) {
  CheckOptions(options);
  if (problem.bend && options.bend) throw UserError("option bend: the board's bend is given");
  if (problem.photos.empty()) throw UserError("photos: found none; at least one is needed");
  State state = bundle::Start(problem, options);
  RejectSmallPhotos(problem, options, &state);
  RequirePhotos(problem, state);
  const int rounds = Iterate(problem, options, &state);
  // Covariances are of small motions beside each pose.
  for (PhotoState& photo : state.photos) photo.Rebase();
  BundleResult result = Summarise(problem, options, state);
  result.rounds = rounds;
  const auto focal_sigmas = bundle::Covariance(problem, options, state, &result);
  RequireFocalLengths(result, focal_sigmas, options);
  return result;
}

}  // namespace glint
