#include "calib/light/light.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/statistics/median.h"
#include "calib/light/contradictions.h"
#include "calib/light/light_state.h"
#include "calib/light/settle.h"
#include "calib/light/thinned.h"

namespace glint {
namespace light {
namespace {

constexpr int kMostRounds = 6;

// Photon noise of a small sensor (8000 electrons), averaged over the disc, and 0.3 % of what no
// model holds; only ratios count, since the whole is scaled by the residuals.
double SigmaOf(double radiance, int pixels) {
  const double level = std::max(radiance, 1e-3);
  return std::sqrt(1.25e-4 * level / pixels + 9e-6 * level * level);
}

PhotoState StateOf(const LightPhoto& photo, const Camera& camera,
                   const std::optional<BoardBend>& bend, int* next_cluster) {
  PhotoState state;
  state.camera = photo.camera;
  state.clips = photo.clips;
  state.exif = photo.exposure;
  std::map<int, int> clusters;
  for (const PaperSample& sample : photo.samples) {
    Spot spot;
    const Eigen::Vector2d& at = sample.position_in_sample_mm;
    const Eigen::Vector2d slopes = bend ? bend->SlopesAt(at) : Eigen::Vector2d(0, 0);
    spot.geometry.spot_in_camera_mm = photo.camera_from_sample * BoardPoint(bend, at);
    if (spot.geometry.spot_in_camera_mm.z() <= 0) continue;
    spot.geometry.normal_in_camera = photo.camera_from_sample.rotation *
                                     Eigen::Vector3d(-slopes.x(), -slopes.y(), 1).normalized();
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
    photo.log_exposure.setConstant(std::log(exif ? photo.exif : Median(shares[i]) / first));
    for (const Spot& spot : photo.spots) {
      double flash = 0;
      if (!FlashOnSpot(spot.geometry, options.offset_mm.data(), 0.0, &flash)) continue;
      for (int c = 0; c < 3; ++c) {
        q[c].push_back(spot.seen[c] / (flash * std::exp(photo.log_exposure[c])));
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

bool Fits(const LightOptions& options, const State& state, const PhotoState& photo,
          const Spot& spot) {
  constexpr double kAlwaysFine = 0.005;  // relative: what quantisation alone may do
  const auto predicted = state.Prediction(photo, spot);
  if (predicted.empty() || (photo.clips && MayClip(predicted))) return false;
  for (int c = 0; c < 3; ++c) {
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
    PhotoState& added = state.photos.emplace_back(
        StateOf(photo, problem.cameras[photo.camera], problem.bend, &clusters));
    added.used = static_cast<int>(added.spots.size()) >= options.min_samples;
  }
  return state;
}

}  // namespace

bool MayClip(const std::vector<double>& predicted) {
  constexpr double kBrightest = 0.9;
  return std::any_of(predicted.begin(), predicted.end(),
                     [](double radiance) { return radiance > kBrightest; });
}

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

bool DropPhotos(const LightOptions& options, State* state) {
  for (PhotoState& photo : state->photos) {
    // A photo of which a share of the spots was kept needs that share.
    const double least = std::max(4.0, photo.kept_share * options.min_samples);
    if (photo.used && Inliers(photo) < least) photo.used = false;
  }
  const auto first = std::find_if(state->photos.begin(), state->photos.end(),
                                  [](const PhotoState& photo) { return photo.used; });
  if (first == state->photos.end()) return false;
  state->first = static_cast<int>(first - state->photos.begin());
  const Eigen::Vector3d shift = first->log_exposure;
  const double exif = first->exif;
  for (PhotoState& photo : state->photos) {
    photo.log_exposure -= shift;
    if (exif > 0) photo.exif /= exif;
  }
  state->log_q += shift;
  return true;
}

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

std::vector<double> State::Prediction(const PhotoState& photo, const Spot& spot) const {
  std::vector<double> radiance(3);
  const double* flash = own_flashes ? photo.flash_mm.data() : flash_mm.data();
  if (!Predict(spot.geometry, reference, flash, log_q.data(), ambient.data(),
               vignetting[photo.camera].data(), &gloss, &smear, tone.data(),
               photo.log_exposure.data(), radiance.data())) {
    return {};
  }
  return radiance;
}

}  // namespace light

constexpr const char* kNoFlash = "the white paper's brightness fits no flash near the lens";

LightEstimate EstimateLight(const LightProblem& problem, const LightOptions& options) {
  LightEstimate estimate;
  light::State start = light::StartState(problem, options);
  if (!light::DropPhotos(options, &start)) {
    estimate.problem = "no photograph shows enough unclipped white paper";
    return estimate;
  }
  light::Start(options, &start);
  if (!light::Settle(problem, options, &start, &estimate.rounds)) {
    estimate.problem = kNoFlash;
    return estimate;
  }
  light::State full = start;
  start = light::Thinned(full, options.spots_per_photo);
  while (true) {
    light::State state = start;
    if (!light::SolveRobustly(options, &state, &estimate.rounds)) {
      estimate.problem = kNoFlash;
      return estimate;
    }
    const light::Layout layout = light::LayoutOf(state);
    const Eigen::MatrixXd covariance = light::Covariance(problem, options, state, layout);
    if (!light::HoldOne(state, layout, covariance, &start, &estimate.held)) {
      estimate.known = true;
      light::Adopt(state, &full);
      light::Reweigh(&full);
      light::Reject(options, &full);
      light::ExplainContradictions(&full);
      light::FillEstimate(problem, options, full, layout, covariance, &estimate);
      return estimate;
    }
  }
}

}  // namespace glint
