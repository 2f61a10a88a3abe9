// Triage of a capture's photographs: named, and left out where that is wanted.
#pragma once

#include <vector>

#include "calib/capture/calib_options.h"
#include "calib/capture/detect_photos.h"
#include "calib/triage/triage.h"

namespace glint {

// Logs every remark as a warning. With triage = "drop" the corners of condemned flash photographs
// are taken away, and the remark becomes the reason why they are left out; the board's own
// photographs stay, since the bundle weighs their corners. "off" gives nothing.
std::vector<Remark> TriagePhotos(const CalibOptions& options, std::vector<DetectedPhoto>* photos);

}  // namespace glint
