// What can be chosen about calibration, and what a capture settles.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/formats/capture.h"
#include "base/programs/options.h"
#include "calib/bundle/bundle.h"

namespace glint {

struct CalibOptions {
  std::string poses = "board";  // board, colmap, colmap:DIR: see colmap_poses.h
  // One of CalibratedModels(kOnDemand); auto: chosen, see validation/model_choice.h
  std::string model = "OPENCV";
  std::string cameras = "auto";          // auto, one, each: see camera_groups.h
  std::vector<std::string> hold;         // distortion parameters held at 0
  std::filesystem::path fix_intrinsics;  // manifest of another calibration; empty: estimate
  std::filesystem::path library;         // see phone_library.h; empty: none
  std::string board_shape = "auto";      // flat; bent: two unknowns, see BoardBend; auto: as found
  std::string write = "none";            // none, colmap: see export_colmap.h
  double reject_sigmas = 5;              // see BundleOptions
  double min_reject_px = 0.5;
  int min_corners = 6;
  int detect_px = 1600;             // boards are looked for in a copy of this size
  std::string light = "board";      // or camera, see capture_light.h
  double plane_tolerance = 0.005;   // COLMAP: see FrameOptions
  int feature_px = 2000;            // COLMAP: features are looked for in a copy of this size
  std::string triage = "warn";      // warn, drop, off: what becomes of bad photographs
  double paper_reflectance = 0.85;  // of the board's white, for the light's power
  int quick_px = 0;  // no option: read photographs reduced to this for a quick look; 0: whole
};

void AddCalibOptions(OptionSet* set, CalibOptions* options);
BundleOptions BundleOptionsOf(const CalibOptions& options);

// The values of capture.toml that the result depends on. They enter the manifest as options, so
// that a change of theirs makes the result stale and others do not.
struct CalibTask {
  std::string board;               // in one line
  std::string poses, poses_frame;  // where poses come from; [poses] in one line
  std::vector<double> board_centre_mm;
  std::string encoding;
  std::vector<double> light_offset_mm, light_power, ambient;
  std::vector<double> sample_mm, resolution_px;  // of the guidance
  std::string sample_height;                     // auto, or millimetres
  std::string chart;                             // [chart] in one line; empty: there is none
};

CalibTask ResolveTask(const Capture& capture, const CalibOptions& options);
void AddTask(OptionSet* set, CalibTask* task);

}  // namespace glint
