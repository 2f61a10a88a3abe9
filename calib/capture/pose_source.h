// Where poses come from, and which of a COLMAP model's images are the capture's photographs.
#pragma once

#include <filesystem>
#include <vector>

#include "base/formats/capture.h"
#include "calib/capture/calib_options.h"
#include "calib/capture/detect_photos.h"
#include "calib/colmap/colmap_model.h"

namespace glint {

// --poses: "board", "colmap" (the program is run), "colmap:DIR" (a model is read) or "above" (one
// photograph from straight above). The capture of a fixed camera has no other source than that it
// stood still. Throws UserError for another text.
enum class PoseSource { kBoard, kColmapProgram, kColmapModel, kAbove, kFixedCamera };
PoseSource PoseSourceOf(const Capture& capture, const CalibOptions& options);
// The folder after "colmap:", from the working folder or else from the capture's.
std::filesystem::path PosesFolder(const Capture& capture, const CalibOptions& options);

// Stops early: no colmap program, no photographs, or nothing that tells the scale.
void CheckPoses(const Capture& capture, const CalibOptions& options);

// Index of the model's image of each photograph, by its path from the capture's folder or else by
// its file name; −1: the model does not hold it. `source` is named in errors. Throws UserError
// where it holds none, or two of one name.
std::vector<int> MatchByName(const Capture& capture, const std::filesystem::path& source,
                             const std::vector<DetectedPhoto>& photos, const ColmapModel& model);

}  // namespace glint
