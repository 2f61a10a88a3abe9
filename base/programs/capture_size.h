// How large a capture is, its photographs included.
#pragma once

#include "base/formats/capture.h"
#include "base/programs/cost_model.h"

namespace glint {

// SizeOfMaps(), and the first photograph's by its header.
CaptureSize SizeOf(const Capture& capture);

}  // namespace glint
