// What the residuals show beyond their size: a bent board, corners that are printed elsewhere,
// rolling shutter, motion. In numbers, per place on the board and per photograph, and in words.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calib/bundle/bundle.h"
#include "calib/validation/photo_pattern.h"

namespace glint {

// One corner of the board over all photographs: where it seems to be, beside where it should be.
struct PlaceMean {
  int id = 0;
  Eigen::Vector2d position_in_sample_mm;
  Eigen::Vector3d offset_mm;  // least squares over the photos; z: off the board's plane
  Eigen::Vector3d sigma_mm;   // by the residuals' standard deviation
  int photos = 0;
};

struct Diagnosis {
  std::vector<PlaceMean> places;     // by id; corners seen in at least three photographs
  double place_rms_mm = 0;           // of the offsets in the plane
  std::vector<PhotoPattern> photos;  // as result.photos
  std::optional<BoardBend> bend;     // of the result, or of a trial with a free bend
  double rms_without_bend_px = 0, rms_with_bend_px = 0;  // of that trial; 0: none was needed
  bool board_is_bent = false;
  std::vector<std::string> words;  // one sentence a finding; "" never
};

// `result` solves `problem` under `options`.
Diagnosis Diagnose(const BundleProblem& problem, const BundleOptions& options,
                   const BundleResult& result);
// The bend alone.
Diagnosis DiagnoseBend(const BundleProblem& problem, const BundleOptions& options,
                       const BundleResult& result);

}  // namespace glint
