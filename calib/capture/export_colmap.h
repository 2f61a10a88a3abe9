// A calibrated capture as a COLMAP model, to look at in COLMAP's program or to go on with there.
#pragma once

#include <filesystem>

#include "base/formats/capture.h"
#include "calib/colmap/colmap_model.h"

namespace glint {

// The model of what calib found: cameras and images of the pictures as they are stored (COLMAP does
// not turn them), named relative to the capture's folder; the board's inlier corners as points with
// their tracks. Units are the sample's millimetres. Where the poses came from COLMAP, its own model
// in that frame. Throws UserError for a manifest that is none.
ColmapModel ModelOfCalibration(const Capture& capture, const std::filesystem::path& manifest_file);

// Writes it, binary, to CAPTURE/glint/colmap and returns the folder.
std::filesystem::path ExportColmap(const Capture& capture,
                                   const std::filesystem::path& manifest_file);

}  // namespace glint
