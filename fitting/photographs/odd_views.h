// Photographs that do not agree with the others: no map explains them.
#pragma once

#include <cstddef>
#include <vector>

namespace glint {

// After refinement, and after the coarser latent fit. In units of the median: of the fourteen
// published sets and some hundred synthetic captures, photographs that are in order have up to 1.8
// and 3.2; one with a smudge 13 and 9, of another sample 25 to 38 and 13 to 48, stored in grey 4.9
// in the fit, in which the sample lay a millimetre aside 3.6 and 2.2.
inline constexpr double kOddOfRefined = 2, kOddOfFitted = 4;

// Indices of views whose loss (mean |log-radiance residual|; not finite: wholly masked) is more
// than `most` times the median, and more than 5 %, which is no harm. None of fewer than four: half
// of them would be.
std::vector<size_t> OddViews(const std::vector<double>& losses, double most);

}  // namespace glint
