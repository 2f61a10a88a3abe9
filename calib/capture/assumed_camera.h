// Intrinsics where photographs do not determine them.
#pragma once

#include "base/camera/camera_model.h"
#include "calib/capture/camera_groups.h"

namespace glint {

// A camera without distortion for the group's stored pictures, its principal point in the middle;
// the focal length is the one reported by EXIF (ReportedFocal_px) or, without one, a 35 mm
// equivalent of 26 mm: phones' main cameras have 23 to 28.
Camera AssumedCamera(const std::vector<DetectedPhoto>& photos, const CameraGroup& group,
                     CameraModel model);

}  // namespace glint
