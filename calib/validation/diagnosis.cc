#include "calib/validation/diagnosis.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/errors/errors.h"
#include "base/statistics/median.h"
#include "calib/uncertainty/projection_jacobian.h"
#include "calib/validation/cross_validation.h"

namespace glint {
namespace {

// A height beyond this many standard deviations, and this share of the board's size (half a sheet's
// thickness), which leaves this share of the residual or less.
constexpr double kBentSigmas = 4, kBentShare = 0.0003, kBentResidual = 0.97;

struct Normal {
  Eigen::Vector2d position;
  Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  int photos = 0;
};

std::vector<PlaceMean> MeanPlaces(const BundleResult& result) {
  constexpr int kLeastViews = 3;
  std::map<int, Normal> places;
  for (const PhotoEstimate& photo : result.photos) {
    if (!photo.rejected.empty()) continue;
    for (const CornerResidual& corner : photo.corners) {
      if (!corner.inlier) continue;
      const Eigen::Vector3d point =
          photo.camera_from_sample * BoardPoint(result.bend, corner.position_in_sample_mm);
      const Eigen::Matrix<double, 2, 3> j =
          Differentiate(result.cameras[photo.camera].camera, point).by_point *
          photo.camera_from_sample.rotation;
      Normal& place = places[corner.id];
      place.position = corner.position_in_sample_mm;
      place.left += j.transpose() * j;
      place.right += j.transpose() * corner.residual_px;
      ++place.photos;
    }
  }
  std::vector<PlaceMean> means;
  for (const auto& [id, place] : places) {
    if (place.photos < kLeastViews) continue;
    Eigen::Matrix3d inverse;
    bool invertible = false;
    place.left.computeInverseWithCheck(inverse, invertible);
    if (!invertible) continue;
    const Eigen::Vector3d variance = inverse.diagonal() * result.sigma_px * result.sigma_px;
    means.push_back({id, place.position, inverse * place.right, variance.cwiseMax(0.0).cwiseSqrt(),
                     place.photos});
  }
  return means;
}

// The same photographs with a free bend; nullopt where that cannot be solved.
std::optional<BundleResult> TrialWithBend(const BundleProblem& problem, BundleOptions options,
                                          const BundleResult& result) {
  options.bend = true;
  options.reject = false;
  try {
    return AdjustBundle(Accepted(problem, result), options);
  } catch (const Error&) {
    return std::nullopt;
  }
}

bool Significant(const BoardBend& bend) {
  const double least_mm = kBentShare * 2 * bend.half_size_mm.maxCoeff();
  for (int i = 0; i < 2; ++i) {
    const double sigma_mm = std::sqrt(bend.covariance(i, i));
    if (std::abs(bend.height_mm[i]) > std::max(least_mm, kBentSigmas * sigma_mm)) return true;
  }
  return false;
}

std::string BendInWords(const Diagnosis& diagnosis, bool solved_for) {
  const BoardBend& bend = *diagnosis.bend;
  std::string text = fmt::format(
      "the board is bent: its middle is {:.2f} ± {:.2f} mm above its left and right edges and "
      "{:.2f} ± {:.2f} mm above its top and bottom edges",
      bend.height_mm.x(), std::sqrt(bend.covariance(0, 0)), bend.height_mm.y(),
      std::sqrt(bend.covariance(1, 1)));
  if (solved_for) return text + "; the result takes that into account";
  return text + fmt::format(
                    " (the residual falls from {:.3f} to {:.3f} px with it); glue it to something "
                    "flat, or give --board-shape bent",
                    diagnosis.rms_without_bend_px, diagnosis.rms_with_bend_px);
}

// The bend, its words, and the result whose residuals are to be looked at further.
BundleResult LookForBend(const BundleProblem& problem, const BundleOptions& options,
                         const BundleResult& result, Diagnosis* out) {
  if (result.bend) {
    out->bend = result.bend;
    out->board_is_bent = Significant(*result.bend);
    if (out->board_is_bent) out->words.push_back(BendInWords(*out, true));
    return result;
  }
  std::optional<BundleResult> bent = TrialWithBend(problem, options, result);
  if (!bent) return result;
  out->bend = bent->bend;
  out->rms_without_bend_px = result.rms_px;
  out->rms_with_bend_px = bent->rms_px;
  out->board_is_bent = Significant(*bent->bend) && bent->rms_px < kBentResidual * result.rms_px;
  if (!out->board_is_bent) return result;
  out->words.push_back(BendInWords(*out, false));
  // Indices of photos and corners stay those of `result` for what follows.
  BundleResult unbent = result;
  unbent.cameras = bent->cameras;
  unbent.bend = bent->bend;
  unbent.sigma_px = bent->sigma_px;
  for (size_t i = 0; i < unbent.photos.size(); ++i) {
    if (unbent.photos[i].rejected.empty()) unbent.photos[i] = bent->photos[i];
  }
  return unbent;
}

std::string Listed(const BundleResult& result, const std::vector<size_t>& photos) {
  constexpr size_t kMost = 4;
  std::string text;
  for (size_t i = 0; i < std::min(kMost, photos.size()); ++i) {
    text += (i ? ", " : "") + result.photos[photos[i]].name;
  }
  if (photos.size() > kMost) text += fmt::format(" and {} more", photos.size() - kMost);
  return text;
}

std::string MotionInWords(const BundleResult& result, const std::vector<size_t>& moved,
                          size_t accepted, bool many, double largest_px) {
  if (many) {
    return fmt::format(
        "in {} of {} photographs residuals vary smoothly over the picture, up to {:.2f} px RMS: "
        "the model of the lens has too few terms (--model auto), the board is not the shape "
        "described, or "
        "all were taken in motion",
        moved.size(), accepted, largest_px);
  }
  return fmt::format(
      "in {} of {} photographs ({}) residuals vary smoothly over the picture, as if the phone or "
      "board had moved while the picture was read out (rolling shutter), up to {:.2f} px RMS; hold "
      "still, or "
      "use more light",
      moved.size(), accepted, Listed(result, moved), largest_px);
}

std::string BlurInWords(const BundleResult& result, const Diagnosis& diagnosis,
                        const std::vector<size_t>& lined, size_t accepted) {
  const PhotoPattern& worst = diagnosis.photos[lined[0]];
  return fmt::format(
      "in {} of {} photographs ({}) corners scatter along one direction ({:.0f} degrees in the "
      "first, {:.1f} times as far as across): blurred by motion",
      lined.size(), accepted, Listed(result, lined), worst.axis_deg,
      worst.mean_length_px / std::max(worst.across_px, 1e-9));
}

// Photographs whose residuals a motion explains. A hand shakes now and then: it must stand out from
// the others, and what most of them show is another fault (`many`).
std::vector<size_t> Moved(const std::vector<PhotoPattern>& photos, double usual_effect_px,
                          size_t accepted, bool* many) {
  constexpr size_t kLeastMany = 3;
  constexpr double kAboveUsual = 2;
  std::vector<size_t> smooth, moved;
  for (size_t i = 0; i < photos.size(); ++i) {
    if (!photos[i].moved_while_read) continue;
    smooth.push_back(i);
    if (photos[i].row_motion_px > kAboveUsual * usual_effect_px) moved.push_back(i);
  }
  *many = smooth.size() >= kLeastMany && 2 * smooth.size() > accepted;
  return *many ? smooth : moved;
}

void LookForMotion(const BundleResult& result, Diagnosis* out) {
  std::vector<double> lengths, effects;
  for (size_t i = 0; i < result.photos.size(); ++i) {
    if (!result.photos[i].rejected.empty()) continue;
    const PhotoPattern pattern = PatternOf(result, i);
    lengths.push_back(pattern.mean_length_px);
    effects.push_back(pattern.row_motion_px);
  }
  const size_t accepted = lengths.size();
  const double usual_px = Median(std::move(lengths)), usual_effect_px = Median(std::move(effects));
  std::vector<size_t> lined;
  for (size_t i = 0; i < result.photos.size(); ++i) {
    out->photos.push_back(result.photos[i].rejected.empty() ? PatternOf(result, i, usual_px)
                                                            : PhotoPattern());
    if (out->photos.back().scattered_on_a_line) lined.push_back(i);
  }
  bool many = false;
  const std::vector<size_t> moved = Moved(out->photos, usual_effect_px, accepted, &many);
  for (PhotoPattern& pattern : out->photos) pattern.moved_while_read = false;
  double largest_px = 0;
  for (const size_t i : moved) {
    out->photos[i].moved_while_read = !many;
    largest_px = std::max(largest_px, out->photos[i].row_motion_px);
  }
  if (!moved.empty()) {
    out->words.push_back(MotionInWords(result, moved, accepted, many, largest_px));
  }
  if (!lined.empty()) out->words.push_back(BlurInWords(result, *out, lined, accepted));
}

// Corners that are printed elsewhere than described: offsets in the plane beyond what noise gives.
void LookForMisprints(const BundleResult& result, Diagnosis* out) {
  constexpr double kSigmas = 5, kLeast_mm = 0.02;
  out->places = MeanPlaces(result);
  double squares = 0;
  int misplaced = 0;
  for (const PlaceMean& place : out->places) {
    squares += place.offset_mm.head<2>().squaredNorm();
    const double sigmas = place.offset_mm.head<2>().cwiseQuotient(place.sigma_mm.head<2>()).norm();
    misplaced += sigmas > kSigmas && place.offset_mm.head<2>().norm() > kLeast_mm;
  }
  const size_t n = out->places.size();
  out->place_rms_mm = std::sqrt(squares / std::max<size_t>(1, n));
  if (n == 0 || misplaced < std::max<int>(2, static_cast<int>(n / 10))) return;
  out->words.push_back(fmt::format(
      "{} of {} corners seem to lie elsewhere on the board than described, by {:.3f} mm RMS over "
      "all: the board is bent other than in two parabolas, or the printer or lens is at fault",
      misplaced, n, out->place_rms_mm));
}

}  // namespace

Diagnosis DiagnoseBend(const BundleProblem& problem, const BundleOptions& options,
                       const BundleResult& result) {
  Diagnosis out;
  LookForBend(problem, options, result, &out);
  return out;
}

Diagnosis Diagnose(const BundleProblem& problem, const BundleOptions& options,
                   const BundleResult& result) {
  Diagnosis out;
  const BundleResult rest = LookForBend(problem, options, result, &out);
  LookForMotion(rest, &out);
  LookForMisprints(rest, &out);
  if (out.board_is_bent && !result.bend) out.places = MeanPlaces(result);
  return out;
}

}  // namespace glint
