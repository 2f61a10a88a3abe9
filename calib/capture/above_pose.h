// One photograph from straight above, without a board: the pose that a person states.
#pragma once

#include "calib/capture/calibrate_capture.h"

namespace glint {

// Fills groups, bundle, photo_index and poses of `summary`, whose photos are detected: the camera
// looks straight down at the sample's middle; its height comes from [poses] picture_width_mm or
// height_mm, its focal length from EXIF or an assumption (assumed_camera.h). Throws UserError: no
// such length, more than one photograph, a sample that the picture does not show whole.
void PoseFromAbove(const Capture& capture, const CalibOptions& options, CalibSummary* summary);

}  // namespace glint
