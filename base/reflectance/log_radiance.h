// Radiances are compared by their logarithms.
#pragma once

#include "base/model/photographs.h"

namespace glint {

// Of the loss |log(I + 0.01) − log(R + 0.01)| (Gao et al. 2019, eq. 2).
using constants::kLogOffset;

}  // namespace glint
