#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/light/light_state.h"

namespace glint::light {
namespace {

// Largest σ of V(r) up to the farthest spot of a camera.
double VignettingSigma(const State& state, int camera, const Eigen::Matrix3d& covariance) {
  double farthest = 0, largest = 0;
  for (const PhotoState& photo : state.photos) {
    if (!photo.used || photo.camera != camera) continue;
    for (const Spot& spot : photo.spots) {
      if (spot.inlier) farthest = std::max(farthest, spot.geometry.r2);
    }
  }
  for (int i = 1; i <= 10; ++i) {
    const double r2 = farthest * i / 10;
    const Eigen::Vector3d powers(r2, r2 * r2, r2 * r2 * r2);
    largest = std::max(largest, std::sqrt(powers.dot(covariance * powers)));
  }
  return largest;
}

// The mean of the channels, and what they differ by.
void FillExposure(const PhotoState& photo, int column, const Eigen::MatrixXd& covariance,
                  LightOfPhoto* of) {
  const double mean = photo.log_exposure.mean();
  of->exposure.value = std::exp(mean);
  of->exif_exposure = photo.exif;
  of->colour = (photo.log_exposure.array() - mean).exp();
  if (column < 0) return;
  const double variance = covariance.block<3, 3>(column, column).sum() / 9;
  of->exposure.sigma = of->exposure.value * std::sqrt(variance);
}

void FillPhotos(const LightProblem& problem, const State& state, const Layout& layout,
                const Eigen::MatrixXd& covariance, LightEstimate* estimate) {
  double all = 0;
  for (size_t i = 0; i < state.photos.size(); ++i) {
    const PhotoState& photo = state.photos[i];
    LightOfPhoto of;
    of.name = problem.photos[i].name;
    of.used = photo.used;
    of.turns = photo.turns;
    of.contradicts = photo.contradicts;
    of.zoom = photo.zoom;
    if (photo.contradicts) FillExposure(photo, -1, covariance, &of);
    of.samples = static_cast<int>(photo.spots.size());
    double squares = 0;
    for (const Spot& spot : photo.spots) {
      const auto predicted = state.Prediction(photo, spot);
      LightOfPhoto::Spot shown{spot.point_px, Eigen::Vector3d::Zero(), photo.used && spot.inlier};
      if (predicted.empty()) shown.inlier = false;
      for (int c = 0; c < 3 && !predicted.empty(); ++c) {
        shown.relative[c] = spot.seen[c] / std::max(predicted[c], 1e-9) - 1;
      }
      if (shown.inlier) squares += shown.relative.squaredNorm() / 3;
      of.inliers += shown.inlier;
      of.unlit += !shown.inlier && !(photo.clips && MayClip(predicted));
      of.spots.push_back(shown);
    }
    if (photo.used) {
      FillExposure(photo, layout.exposure[i], covariance, &of);
      of.rms_percent = 100 * std::sqrt(squares / std::max(1, of.inliers));
      estimate->samples += of.samples;
      estimate->inliers += of.inliers;
      all += squares;
    }
    estimate->photos.push_back(std::move(of));
  }
  estimate->rms_percent = 100 * std::sqrt(all / std::max(1, estimate->inliers));
}

// Power, reflectance and ambient light from q and a.
void FillRadiometry(const LightOptions& options, const State& state, const Layout& layout,
                    const Eigen::MatrixXd& covariance, LightEstimate* estimate) {
  for (int c = 0; c < 3; ++c) {
    const double q = std::exp(state.log_q[c]);
    const int column = layout.log_q + c;
    const double relative = std::sqrt(covariance(column, column));
    const bool given = options.power[c] > 0;
    const double power = given ? options.power[c] : q * kPi / options.paper_reflectance;
    const double paper = given ? q * kPi / power : options.paper_reflectance;
    estimate->power_rgb[c] = {power, given ? 0 : power * relative};
    estimate->paper_rgb[c] = {paper, given ? paper * relative : 0};
    const double ambient = state.ambient[c] * state.reference * power;
    double sigma = 0;
    if (layout.ambient >= 0) {
      const int other = layout.ambient + c;
      const double scale = state.reference * power;
      double variance = scale * scale * covariance(other, other);
      if (!given) {
        variance += ambient * ambient * relative * relative +
                    2 * ambient * scale * covariance(column, other);
      }
      sigma = std::sqrt(std::max(0.0, variance));
    }
    estimate->ambient_rgb[c] = {std::max(0.0, ambient), sigma};
  }
  if (layout.tone >= 0) {
    const auto sigma = [&](int i) {
      return std::sqrt(covariance(layout.tone + i, layout.tone + i));
    };
    estimate->tone = ToneCurve{
        {Estimate{state.tone[0], sigma(0)}, {state.tone[1], sigma(1)}, {state.tone[2], sigma(2)}},
        1,
        0};
    for (const PhotoState& photo : state.photos) {
      for (const Spot& spot : photo.spots) {
        if (!photo.used || !spot.inlier) continue;
        estimate->tone->lowest = std::min(estimate->tone->lowest, spot.seen.minCoeff());
        estimate->tone->highest = std::max(estimate->tone->highest, spot.seen.maxCoeff());
      }
    }
  }
  estimate->srgb = state.srgb;
  estimate->flash_along_free = state.flash_along_free;
  estimate->smear = {state.smear, std::sqrt(covariance(layout.smear, layout.smear))};
  estimate->gloss.value = state.gloss * options.paper_reflectance;
  if (layout.gloss >= 0) {
    estimate->gloss.sigma =
        options.paper_reflectance * std::sqrt(covariance(layout.gloss, layout.gloss));
  }
}

void FillGeometry(const State& state, const Layout& layout, const Eigen::MatrixXd& covariance,
                  LightEstimate* estimate) {
  for (int i = 0; i < 3; ++i) {
    estimate->flash_in_camera_mm[i].value = state.flash_mm[i];
    if (layout.flash < 0) continue;
    estimate->flash_in_camera_mm[i].sigma =
        std::sqrt(covariance(layout.flash + i, layout.flash + i));
  }
  for (size_t c = 0; c < state.vignetting.size(); ++c) {
    std::array<Estimate, 3> v;
    double sigma = 0;
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
    const int column = layout.vignetting[c];
    for (int i = 0; i < 3; ++i) {
      v[i].value = state.vignetting[c][i];
      if (column >= 0) v[i].sigma = std::sqrt(covariance(column + i, column + i));
    }
    if (column >= 0) {
      own = covariance.block<3, 3>(column, column);
      sigma = VignettingSigma(state, static_cast<int>(c), own);
    }
    estimate->vignetting.push_back(v);
    estimate->vignetting_covariance.push_back(own);
    estimate->vignetting_sigma.push_back(sigma);
  }
}

}  // namespace

bool HoldOne(const State& state, const Layout& layout, const Eigen::MatrixXd& covariance,
             State* held, std::vector<std::string>* words) {
  constexpr double kGloss = 0.02, kAmbient = 0.03, kVignetting = 0.03, kFlash_mm = 8;
  const auto sigma = [&](int column) { return std::sqrt(covariance(column, column)); };
  if (layout.gloss >= 0 && sigma(layout.gloss) > kGloss) {
    held->hold_gloss = true;
    held->gloss = 0;
    words->push_back(
        "the paper's gloss is fixed at 0: the photographs do not distinguish it from the "
        "light's fall-off");
    return true;
  }
  if (layout.ambient >= 0) {
    double worst = 0;
    for (int c = 0; c < 3; ++c) worst = std::max(worst, sigma(layout.ambient + c));
    if (worst > kAmbient) {
      held->hold_ambient = true;
      held->ambient.setZero();
      words->push_back(fmt::format(
          "the ambient illumination is fixed at 0: it would be uncertain by {:.1f} % of the flash; "
          "to determine it, take more photographs from several heights and sides",
          100 * worst));
      return true;
    }
  }
  for (size_t c = 0; c < layout.vignetting.size(); ++c) {
    if (layout.vignetting[c] < 0) continue;
    const double worst =
        VignettingSigma(state, static_cast<int>(c),
                        covariance.block<3, 3>(layout.vignetting[c], layout.vignetting[c]));
    if (worst <= kVignetting) continue;
    held->hold_vignetting[c] = true;
    words->push_back(
        fmt::format("the lens's fall-off of camera {} is fixed: it would be uncertain by {:.1f} %; "
                    "to determine it, take more photographs with the board near the picture's edge",
                    c, 100 * worst));
    return true;
  }
  if (layout.flash >= 0) {
    const double worst = std::max(sigma(layout.flash), sigma(layout.flash + 1));
    if (worst > kFlash_mm) {
      held->hold_flash = true;
      words->push_back(
          fmt::format("the flash is fixed at [light] offset_mm: its position would be uncertain by "
                      "{:.0f} mm; to determine it, take tilted photographs from several sides",
                      worst));
      return true;
    }
  }
  return false;
}

void FillEstimate(const LightProblem& problem, const LightOptions& options, const State& state,
                  const Layout& layout, const Eigen::MatrixXd& covariance,
                  LightEstimate* estimate) {
  FillGeometry(state, layout, covariance, estimate);
  FillRadiometry(options, state, layout, covariance, estimate);
  FillPhotos(problem, state, layout, covariance, estimate);
}

}  // namespace glint::light
