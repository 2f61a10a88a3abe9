// The stage "calib": photographs of a capture to cameras, poses and light.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/formats/calibration.h"
#include "base/programs/program.h"
#include "base/programs/stage.h"
#include "calib/bundle/bundle.h"
#include "calib/capture/calib_options.h"
#include "calib/capture/camera_groups.h"
#include "calib/capture/detect_photos.h"
#include "calib/capture/trust.h"
#include "calib/chart/chart_result.h"
#include "calib/guidance/verdict.h"
#include "calib/light/light.h"
#include "calib/light/power.h"
#include "calib/moving_light/lamp_strengths.h"
#include "calib/registration/register_sample.h"
#include "calib/triage/triage.h"

namespace glint {

inline constexpr int kCalibVersion = 22;

struct RejectedPhoto {
  std::string name, reason;
};

struct CalibSummary {
  Calibration calibration;
  std::vector<DetectedPhoto> photos;
  std::vector<Remark> remarks;  // of triage
  CameraGroups groups;
  BundleResult bundle;              // of the stored pictures
  Trust trust;                      // in that result; empty unless from_board()
  std::vector<size_t> photo_index;  // which of `photos` each photo of `bundle` is
  std::vector<RejectedPhoto> rejected;
  Json poses;           // of COLMAP: what is known of its model and the sample's plane; else null
  LightEstimate light;  // photos as calibration.photos; known: the board told it
  std::vector<std::string> light_findings;     // see light_findings.h
  std::vector<RejectedPhoto> left_out_before;  // so far
  std::vector<std::string> board_findings;     // see board_side.h
  PowerEstimate power;                         // otherwise; photo_power as calibration.photos
  std::string power_source;      // "capture.toml", "board", "board, light at the lens" or "guess"
  SampleRegistration placement;  // of the sample above or below the board; see place_sample.h
  LampStrengths lamps;           // of a fixed camera; photos as calibration.photos
  Verdict guidance;
  std::optional<ChartResult> chart;  // see capture_chart.h

  bool from_board() const { return poses.is_null(); }
  // Indices of the flash photographs that are used, as calibration.photos has them.
  std::vector<size_t> FlashPhotos() const;
  // Why a flash photograph is left out; "": it is not.
  std::string ReasonLeftOut(size_t photo) const;
  // Index into bundle.photos of a detected photograph; −1: it has no corners.
  int BundleIndex(size_t photo) const;
};

// The files that the result depends on.
std::vector<std::filesystem::path> CalibInputs(const Capture& capture, const CalibOptions& options);

// Detects, solves, writes residual pictures and residuals.json through the stage, and commits.
// Throws UserError and ComputationError as its parts do.
CalibSummary CalibrateCapture(const Capture& capture, const CalibOptions& options,
                              const CommonOptions& common, Stage* stage);

// Its steps. Corners and cameras; then all but what is written. `assumed`: intrinsics to take as
// they are, one per camera, or none at all.
CalibSummary DetectCapture(const Capture& capture, const CalibOptions& options, int threads);
void SolveCapture(const Capture& capture, const CalibOptions& options,
                  const std::vector<Camera>& assumed, int threads, CalibSummary* summary);
// With intrinsics as assumed_camera.h has them, after a detection or a failed SolveCapture.
void SolveWithAssumedCameras(const Capture& capture, const CalibOptions& options, int threads,
                             CalibSummary* summary);

// report.cc
Json MetricsOf(const CalibSummary& summary);
Json ResidualsOf(const CalibSummary& summary);
std::string TextOf(const CalibSummary& summary);
// In one line, and those that a person should read at once: what was left out, what to do better.
std::string BriefTextOf(const CalibSummary& summary);

}  // namespace glint
