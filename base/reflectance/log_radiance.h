// Radiances are compared by their logarithms.
#pragma once

namespace glint {

// Of the loss |log(I + 0.01) − log(R + 0.01)| (Gao et al. 2019, eq. 2).
inline constexpr double kLogOffset = 0.01;

}  // namespace glint
