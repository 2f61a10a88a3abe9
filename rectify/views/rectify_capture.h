// The rectify stage: all accepted photographs of a capture to linear top views.
#pragma once

#include <filesystem>
#include <vector>

#include "base/formats/calibration.h"
#include "base/formats/capture.h"
#include "base/formats/rectified_set.h"
#include "base/programs/program.h"
#include "base/programs/stage.h"
#include "rectify/views/rectify_options.h"

namespace glint {

// Raised whenever the same inputs give other bytes.
inline constexpr int kRectifyVersion = 14;

// Throws UserError when a photograph is not the one that calib saw, or not of its camera's size.
void CheckPhotos(const Capture& capture, const Calibration& calibration,
                 const std::filesystem::path& calibration_file);

struct RectifySummary {
  RectifiedSet set;
  Json metrics;  // per view its ViewCounts
};

// Writes view_000.exr … as outputs of `stage`, in capture order, and commits it. One or two
// photographs are in memory at a time.
RectifySummary RectifyCapture(const Capture& capture, const Calibration& calibration,
                              const RectifyOptions& options, const RectifyTask& task,
                              const CommonOptions& common, Stage* stage);

}  // namespace glint
