// Held-out photographs beside their renderings, as one picture.
#pragma once

#include <string>

#include "base/images/image.h"
#include "datasets/evaluation/held_out_views.h"

namespace glint {

// For each set (downwards), and each held-out view of the split (to the right): photograph,
// rendering by `method`, and four times their absolute difference; gamma 2.2.
Image DrawHeldOutSheet(const HoldoutResult& result, const std::string& split,
                       const std::string& method, int threads);

}  // namespace glint
