// Bad photographs that came in through Studio and that nobody has decided about are left out; what
// was there before Studio is not touched.
#pragma once

#include <filesystem>

#include "pipeline/studio/photographs/check_queue.h"

namespace glint {

// Under the capture's mutex.
void LeaveOutBad(const std::filesystem::path& capture, CheckQueue* checks);

}  // namespace glint
