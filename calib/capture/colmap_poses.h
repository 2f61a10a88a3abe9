// Poses and intrinsics from a COLMAP model instead of the board.
#pragma once

#include <filesystem>
#include <string>

#include "calib/capture/calibrate_capture.h"

namespace glint {

// Fills groups, bundle, photo_index and poses of `summary`, whose photos are detected (their
// corners empty where there is no board). The bundle's corners are the model's features. Writes the
// model, moved into the sample's frame, to the stage's outputs colmap/*.bin. Throws UserError and
// what RunColmap throws.
void PosesFromColmap(const Capture& capture, const CalibOptions& options,
                     const CommonOptions& common, Stage* stage, CalibSummary* summary);

}  // namespace glint
