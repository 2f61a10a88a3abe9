#include "calib/light/contradictions.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "base/colour/srgb.h"
#include "base/statistics/median.h"

namespace glint::light {
namespace {

constexpr double kContradiction = 0.182;  // ln 1.2: exposure against EXIF
constexpr double kAgree = 0.06;           // median deviation of those that agree
// Half of the squared residuals that a freedom must save: e⁵ : 1, against odds of one capture in
// ten in which EXIF, encoding or [light] are wrong.
constexpr double kInsists = 5;
constexpr double kSignificant = 5;  // standard deviations
// In the same unit, e² : 1: apps edit more photographs than there are flashes before or behind the
// lens; and what says nothing for sRGB leaves gamma 2.2.
constexpr double kUsual = 2;

// ln(exposure by the paper / by EXIF), less the median over photos; 0: not used.
std::vector<double> Deviations(const State& state, int* used) {
  std::vector<double> deviations(state.photos.size(), 0), all;
  for (size_t i = 0; i < state.photos.size(); ++i) {
    const PhotoState& photo = state.photos[i];
    if (!photo.used || photo.exif <= 0) continue;
    deviations[i] = photo.log_exposure.mean() - std::log(photo.exif);
    all.push_back(deviations[i]);
  }
  *used = static_cast<int>(all.size());
  if (all.empty()) return deviations;
  const double middle = Median(all);
  for (size_t i = 0; i < state.photos.size(); ++i) {
    if (state.photos[i].used) deviations[i] -= middle;
  }
  return deviations;
}

// RMS of ln(seen / predicted) about its mean over a photo's spots, were it enlarged by `zoom`.
double FalloffMisfit(const State& state, const PhotoState& photo, double zoom) {
  double depth = 0;
  for (const Spot& spot : photo.spots) depth += spot.geometry.spot_in_camera_mm.z();
  depth /= static_cast<double>(std::max<size_t>(1, photo.spots.size()));
  std::vector<double> logs;
  for (const Spot& spot : photo.spots) {
    Spot moved = spot;
    moved.geometry.spot_in_camera_mm.z() += (zoom - 1) * depth;
    moved.geometry.r2 /= zoom * zoom;
    const auto predicted = state.Prediction(photo, moved);
    if (predicted.empty() || !(spot.seen[1] > 0)) continue;
    logs.push_back(std::log(spot.seen[1] / predicted[1]));
  }
  if (logs.empty()) return 0;
  const double middle = Median(logs);
  for (double& value : logs) value = std::abs(value - middle);
  return 1.4826 * Median(logs);
}

// Medians of ln(seen / predicted) of R, G, B.
Eigen::Vector3d LogBrightness(const State& state, const PhotoState& photo) {
  std::vector<double> logs[3];
  for (const Spot& spot : photo.spots) {
    const auto predicted = state.Prediction(photo, spot);
    for (int c = 0; c < 3 && !predicted.empty(); ++c) {
      if (spot.seen[c] > 0) logs[c].push_back(std::log(spot.seen[c] / predicted[c]));
    }
  }
  Eigen::Vector3d brightness(0, 0, 0);
  for (int c = 0; c < 3; ++c) brightness[c] = logs[c].empty() ? 0 : Median(logs[c]);
  return brightness;
}

// The enlargement that explains the exposure: as much farther off, paper is darker by its square.
double ZoomOf(const State& state, const PhotoState& photo, double deviation) {
  constexpr double kBetter = 0.7;  // of the misfit
  const double zoom = std::exp(-deviation / 2);
  return FalloffMisfit(state, photo, zoom) < kBetter * FalloffMisfit(state, photo, 1) ? zoom : 1;
}

// Of photos that are used: blocks of squares, whose spots share their errors.
int Blocks(const State& state) {
  std::set<int> blocks;
  for (const PhotoState& photo : state.photos) {
    for (const Spot& spot : photo.spots) {
      if (photo.used && spot.inlier) blocks.insert(spot.cluster);
    }
  }
  return static_cast<int>(blocks.size());
}

int Used(const State& state) {
  return static_cast<int>(std::count_if(state.photos.begin(), state.photos.end(),
                                        [](const PhotoState& photo) { return photo.used; }));
}

// Photographs that `a` explains and `b` does not.
int LostBy(const State& b, const State& a) {
  int lost = 0;
  for (size_t i = 0; i < a.photos.size(); ++i) lost += a.photos[i].used && !b.photos[i].used;
  return lost;
}

// Negative logarithm, but for a constant, of the prior probability of the flash's distance from the
// lens's plane, or from where it is said to be. (Misfit() has its square too, among thousands.)
double FlashEnergy(const LightOptions& options, const State& state) {
  const double sd_mm = state.flash_along_free ? kPrior.flash_free_mm : kPrior.flash_along_mm;
  const double off = (state.flash_mm.z() - options.offset_mm.z()) / sd_mm;
  return off * off / 2 + std::log(sd_mm);
}

// d ln T/d ln L, T what sRGB's curve makes of L by gamma 2.2, where it made `radiance`.
double StretchBySrgb(double radiance) {
  constexpr double kStep = 1.01;
  const double stored = SrgbFromLinear(std::clamp(radiance, 1e-3, 0.97));
  return std::log(SrgbForGamma22(std::pow(stored * kStep, 2.2)) /
                  SrgbForGamma22(std::pow(stored / kStep, 2.2))) /
         (2 * 2.2 * std::log(kStep));
}

// As one curve compresses radiance it compresses residuals: these are compared as gamma 2.2 has
// them.
void MeasureByGamma22(State* state) {
  if (!state->srgb) return;
  double sum = 0, count = 0;
  for (PhotoState& photo : state->photos) {
    for (Spot& spot : photo.spots) {
      for (int c = 0; c < 3; ++c) {
        const double stretch = StretchBySrgb(spot.seen[c]);
        spot.sigma[c] *= stretch;
        if (!photo.used || !spot.inlier) continue;
        sum += std::log(stretch);
        ++count;
      }
    }
  }
  if (count > 0) state->scale /= std::exp(sum / count);
}

// Half of the squared residuals by which `solved` is better than `other`, were a block of squares
// one sample; who explains more photographs is better beyond comparison.
double Saved(const LightOptions& options, State solved, State other) {
  constexpr double kBeyond = 1e9;
  const int lost = LostBy(solved, other), gained = LostBy(other, solved);
  if (lost != gained) return lost > gained ? -kBeyond : kBeyond;
  for (size_t i = 0; i < solved.photos.size(); ++i) {
    const bool both = solved.photos[i].used && other.photos[i].used;
    solved.photos[i].used = other.photos[i].used = both;
  }
  if (solved.srgb != other.srgb) {
    MeasureByGamma22(&solved);
    MeasureByGamma22(&other);
  }
  const double scale = std::min(solved.scale, other.scale);
  const double ours = Misfit(options, solved, scale), theirs = Misfit(options, other, scale);
  if (!std::isfinite(ours) || !(ours > 0)) return -kBeyond;
  if (!std::isfinite(theirs)) return kBeyond;
  const double by_paper = 0.5 * Blocks(other) * std::log(theirs / ours);
  return by_paper + FlashEnergy(options, other) - FlashEnergy(options, solved);
}

// Whether the curve rises as far as the paper shows it.
bool ToneRises(const State& state) {
  constexpr double kLeastSlope = 0.05;
  ToneCurve curve;
  for (int i = 0; i < 3; ++i) curve.t[i].value = state.tone[i];
  for (const PhotoState& photo : state.photos) {
    for (const Spot& spot : photo.spots) {
      if (!photo.used || !spot.inlier) continue;
      for (const double radiance : spot.seen) {
        if (curve.ExponentAt(std::max(radiance, 1e-3)) < kLeastSlope) return false;
      }
    }
  }
  return true;
}

bool LeaveOut(const LightOptions& options, size_t photo, State* start) {
  start->photos[photo].used = false;
  start->photos[photo].contradicts = true;
  return DropPhotos(options, start);
}

}  // namespace

bool LeaveOutContradiction(const LightOptions& options, const State& solved, State* start) {
  for (size_t i = 0; i < start->photos.size(); ++i) {  // whose paper is an outlier as a whole
    if (start->photos[i].used && !solved.photos[i].used) return LeaveOut(options, i, start);
  }
  int used = 0;
  const std::vector<double> deviations = Deviations(solved, &used);
  if (used < 3) return false;
  std::vector<double> sizes;
  for (size_t i = 0; i < deviations.size(); ++i) {
    if (solved.photos[i].used) sizes.push_back(std::abs(deviations[i]));
  }
  if (Median(sizes) > kAgree) return false;  // EXIF's exposures do not hold at all
  const auto worst = std::max_element(deviations.begin(), deviations.end(),
                                      [](double a, double b) { return std::abs(a) < std::abs(b); });
  if (std::abs(*worst) < kContradiction) return false;
  const size_t index = static_cast<size_t>(worst - deviations.begin());
  return LeaveOut(options, index, start);
}

void ExplainContradictions(State* solved) {
  constexpr int kRounds = 4;  // a tone curve's exponent is not 1
  for (PhotoState& photo : solved->photos) {
    if (!photo.contradicts) continue;
    for (int round = 0; round < kRounds; ++round)
      photo.log_exposure += LogBrightness(*solved, photo);
    if (photo.exif > 0) {
      photo.zoom = ZoomOf(*solved, photo, photo.log_exposure.mean() - std::log(photo.exif));
    }
  }
}

namespace {

// A solution with one term more, beside those that hold it.
struct Freedom {
  State start, solved;
  // Of the term: its length in standard deviations, smooth errors counted; 0: there is no solution.
  double significance = 0;
};

Freedom Try(const LightProblem& problem, const LightOptions& options, State start) {
  Freedom freedom;
  freedom.solved = freedom.start = std::move(start);
  int rounds = 0;
  if (!SolveRobustly(options, &freedom.solved, &rounds)) return freedom;
  const State& solved = freedom.solved;
  const Layout layout = LayoutOf(solved);
  const Eigen::MatrixXd covariance = Covariance(problem, options, solved, layout);
  if (layout.tone >= 0) {
    const Eigen::Matrix3d block = covariance.block<3, 3>(layout.tone, layout.tone);
    freedom.significance = std::sqrt(solved.tone.dot(block.ldlt().solve(solved.tone)));
  } else if (layout.flash >= 0) {
    const int z = layout.flash + 2;
    freedom.significance =
        std::abs(solved.flash_mm.z() - options.offset_mm.z()) / std::sqrt(covariance(z, z));
  }
  return freedom;
}

}  // namespace

bool Insists(const LightOptions& options, const State& solved, const State& other) {
  return Saved(options, solved, other) > kInsists;
}

bool Prefers(const LightOptions& options, const State& solved, const State& other) {
  return Saved(options, solved, other) > kUsual;
}

bool FreeWhatThePaperInsistsOn(const LightProblem& problem, const LightOptions& options,
                               State* start, State* solved) {
  State with_tone = *start, with_along = *start;
  with_tone.hold_tone = false;
  with_along.flash_along_free = true;
  Freedom tone, along = Try(problem, options, with_along);
  // One or two photographs' fall-off is the lens's as well as a curve's.
  if (!options.tone_known && Used(*start) > 2) tone = Try(problem, options, with_tone);
  const bool tone_insists = tone.significance > kSignificant && ToneRises(tone.solved) &&
                            Insists(options, tone.solved, *solved);
  const bool along_insists =
      along.significance > kSignificant && Insists(options, along.solved, *solved);
  if (!tone_insists && !along_insists) return false;
  const bool take_tone =
      tone_insists && (!along_insists || Saved(options, tone.solved, along.solved) > -kUsual);
  Freedom& taken = take_tone ? tone : along;
  *start = std::move(taken.start);
  *solved = std::move(taken.solved);
  return true;
}

}  // namespace glint::light
