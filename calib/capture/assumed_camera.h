// Intrinsics where photographs do not tell them.
#pragma once

#include "calib/camera/camera_model.h"
#include "calib/capture/camera_groups.h"

namespace glint {

// A camera without distortion for the group's stored pictures, its principal point in the middle;
// the focal length is EXIF's 35 mm equivalent of the group's first photograph or, without one,
// 26 mm: phones' main cameras have 23 to 28.
Camera AssumedCamera(const std::vector<DetectedPhoto>& photos, const CameraGroup& group,
                     CameraModel model);

// Whether EXIF tells the focal length.
bool FocalTold(const std::vector<DetectedPhoto>& photos, const CameraGroup& group);

}  // namespace glint
