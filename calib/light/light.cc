#include "calib/light/light.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "calib/light/light_state.h"

namespace glint {
namespace light {
namespace {

constexpr double kBrightest = 0.9;  // predicted radiance beyond which a sample may have clipped
constexpr int kMostRounds = 6;

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Photon noise of a small sensor (8000 electrons), averaged over the disc, and 0.3 % of what no
// model holds; only ratios count, since the whole is scaled by the residuals.
double SigmaOf(double radiance, int pixels) {
  const double level = std::max(radiance, 1e-3);
  return std::sqrt(1.25e-4 * level / pixels + 9e-6 * level * level);
}

PhotoState StateOf(const LightPhoto& photo, const Camera& camera, int* next_cluster) {
  PhotoState state;
  state.camera = photo.camera;
  state.clips = photo.clips;
  state.exif = photo.exposure;
  std::map<int, int> clusters;
  for (const PaperSample& sample : photo.samples) {
    Spot spot;
    const Eigen::Vector2d& at = sample.position_in_sample_mm;
    spot.geometry.spot_in_camera_mm = photo.camera_from_sample * Eigen::Vector3d(at.x(), at.y(), 0);
    if (spot.geometry.spot_in_camera_mm.z() <= 0) continue;
    spot.geometry.normal_in_camera = photo.camera_from_sample.rotation.col(2);
    spot.point_px = ImageFromCamera(camera, spot.geometry.spot_in_camera_mm);
    spot.geometry.r2 = VignettingRadius2(camera, spot.point_px);
    spot.seen = sample.radiance;
    spot.pixels = std::max(1, sample.pixels);
    spot.geometry.smear = SmearOf(sample.ink_px);
    const auto [cluster, added] = clusters.insert({sample.block, *next_cluster});
    *next_cluster += added;
    spot.cluster = cluster->second;
    for (int c = 0; c < 3; ++c) spot.sigma[c] = SigmaOf(spot.seen[c], spot.pixels);
    state.spots.push_back(spot);
  }
  return state;
}

// Exposures by EXIF or by what each photo shows, q by the median.
void Start(const LightOptions& options, State* state) {
  std::vector<double> geometry, q[3];
  std::vector<std::vector<double>> shares(state->photos.size());
  for (size_t i = 0; i < state->photos.size(); ++i) {
    if (!state->photos[i].used) continue;
    for (const Spot& spot : state->photos[i].spots) {
      double flash = 0;
      if (!FlashOnSpot(spot.geometry, options.offset_mm.data(), 0.0, &flash)) continue;
      geometry.push_back(flash);
      shares[i].push_back(spot.seen.sum() / flash);
    }
  }
  state->reference = Median(geometry);
  const bool exif = std::all_of(state->photos.begin(), state->photos.end(),
                                [](const PhotoState& p) { return !p.used || p.exif > 0; });
  const double first = Median(shares[state->first]), first_exif = state->photos[state->first].exif;
  for (size_t i = 0; i < state->photos.size(); ++i) {
    PhotoState& photo = state->photos[i];
    if (!photo.used) continue;
    photo.exif = exif ? photo.exif / first_exif : 0;
    photo.log_exposure = std::log(exif ? photo.exif : Median(shares[i]) / first);
    for (const Spot& spot : photo.spots) {
      double flash = 0;
      if (!FlashOnSpot(spot.geometry, options.offset_mm.data(), 0.0, &flash)) continue;
      for (int c = 0; c < 3; ++c) {
        q[c].push_back(spot.seen[c] / (flash * std::exp(photo.log_exposure)));
      }
    }
  }
  for (int c = 0; c < 3; ++c) state->log_q[c] = std::log(std::max(1e-12, Median(q[c])));
}

// Given ambient light in the unit of the parameters; it depends on q where the power is not given.
void SetGivenAmbient(const LightOptions& options, State* state) {
  if (!options.ambient) return;
  for (int c = 0; c < 3; ++c) {
    const double power = options.power[c] > 0
                             ? options.power[c]
                             : std::exp(state->log_q[c]) * kPi / options.paper_reflectance;
    state->ambient[c] = (*options.ambient)[c] / (power * state->reference);
  }
}

// Residuals' scale from the inliers' median; new weights from the prediction.
void Reweigh(State* state) {
  std::vector<double> sizes;
  for (PhotoState& photo : state->photos) {
    if (!photo.used) continue;
    for (Spot& spot : photo.spots) {
      const auto predicted = state->Prediction(photo, spot);
      if (predicted.empty()) continue;
      for (int c = 0; c < 3; ++c) {
        spot.sigma[c] = SigmaOf(predicted[c], spot.pixels);
        if (spot.inlier) sizes.push_back(std::abs(spot.seen[c] - predicted[c]) / spot.sigma[c]);
      }
    }
  }
  state->scale = std::max(1e-6, 1.4826 * Median(sizes));
}

bool Fits(const LightOptions& options, const State& state, const PhotoState& photo,
          const Spot& spot) {
  constexpr double kAlwaysFine = 0.005;  // relative: what quantisation alone may do
  const auto predicted = state.Prediction(photo, spot);
  if (predicted.empty()) return false;
  for (int c = 0; c < 3; ++c) {
    if (photo.clips && predicted[c] > kBrightest) return false;
    const double limit =
        std::max(options.reject_sigmas * state.scale * spot.sigma[c], kAlwaysFine * predicted[c]);
    if (!(std::abs(spot.seen[c] - predicted[c]) <= limit)) return false;
  }
  return true;
}

// Returns whether anything changed.
bool Reject(const LightOptions& options, State* state) {
  bool changed = false;
  for (PhotoState& photo : state->photos) {
    if (!photo.used) continue;
    for (Spot& spot : photo.spots) {
      const bool inlier = Fits(options, *state, photo, spot);
      changed = changed || inlier != spot.inlier;
      spot.inlier = inlier;
    }
  }
  return changed;
}

int Inliers(const PhotoState& photo) {
  return static_cast<int>(std::count_if(photo.spots.begin(), photo.spots.end(),
                                        [](const Spot& spot) { return spot.inlier; }));
}

// A photo without enough spots leaves; false: none is left.
bool DropPhotos(const LightOptions& options, State* state) {
  for (PhotoState& photo : state->photos) {
    if (photo.used && Inliers(photo) < options.min_samples) photo.used = false;
  }
  const auto first = std::find_if(state->photos.begin(), state->photos.end(),
                                  [](const PhotoState& photo) { return photo.used; });
  if (first == state->photos.end()) return false;
  state->first = static_cast<int>(first - state->photos.begin());
  const double shift = first->log_exposure;
  const double exif = first->exif;
  for (PhotoState& photo : state->photos) {
    photo.log_exposure -= shift;
    if (exif > 0) photo.exif /= exif;
  }
  for (int c = 0; c < 3; ++c) state->log_q[c] += shift;
  return true;
}

// Robust solutions until nothing changes sides, then plain least squares. False: nothing is left.
bool SolveRobustly(const LightOptions& options, State* state, int* rounds) {
  for (bool robust : {true, false}) {
    for (int round = 0; round < kMostRounds; ++round) {
      SetGivenAmbient(options, state);
      Solve(options, robust, state);
      Reweigh(state);
      ++*rounds;
      const bool changed = Reject(options, state);
      if (!DropPhotos(options, state)) return false;
      if (!changed && round > 0) break;
    }
  }
  SetGivenAmbient(options, state);
  Solve(options, false, state);
  return true;
}

State StartState(const LightProblem& problem, const LightOptions& options) {
  State state;
  state.flash_mm = options.offset_mm;
  state.hold_ambient = options.ambient.has_value();
  for (const Camera& camera : problem.cameras) {
    state.vignetting.emplace_back(camera.vignetting.data());
  }
  state.hold_vignetting.assign(problem.cameras.size(), false);
  int clusters = 0;
  for (const LightPhoto& photo : problem.photos) {
    PhotoState& added =
        state.photos.emplace_back(StateOf(photo, problem.cameras[photo.camera], &clusters));
    added.used = static_cast<int>(added.spots.size()) >= options.min_samples;
  }
  return state;
}

}  // namespace

std::vector<double> State::Prediction(const PhotoState& photo, const Spot& spot) const {
  std::vector<double> radiance(3);
  if (!Predict(spot.geometry, reference, flash_mm.data(), log_q.data(), ambient.data(),
               vignetting[photo.camera].data(), &gloss, &smear, &photo.log_exposure,
               radiance.data())) {
    return {};
  }
  return radiance;
}

}  // namespace light

LightEstimate EstimateLight(const LightProblem& problem, const LightOptions& options) {
  LightEstimate estimate;
  light::State start = light::StartState(problem, options);
  if (!light::DropPhotos(options, &start)) {
    estimate.problem = "no photograph shows enough unclipped white paper";
    return estimate;
  }
  light::Start(options, &start);
  while (true) {
    light::State state = start;
    if (!light::SolveRobustly(options, &state, &estimate.rounds)) {
      estimate.problem = "the white paper's brightness fits no flash near the lens";
      return estimate;
    }
    const double along_mm = state.flash_mm.z() - options.offset_mm.z();
    if (!start.flash_along_free && std::abs(along_mm) > 3 * light::kPrior.flash_along_mm) {
      start.flash_along_free = true;
      continue;
    }
    const light::Layout layout = light::LayoutOf(state);
    const Eigen::MatrixXd covariance = light::Covariance(problem, options, state, layout);
    if (light::HoldOne(state, layout, covariance, &start, &estimate.held)) continue;
    estimate.known = true;
    light::FillEstimate(problem, options, state, layout, covariance, &estimate);
    return estimate;
  }
}

}  // namespace glint
