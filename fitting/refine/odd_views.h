// Photographs that do not go with the others: no map explains them.
#pragma once

#include <cstddef>
#include <vector>

namespace glint {

// Indices of views whose loss (mean |log-radiance residual|; not finite: wholly masked) is more
// than twice the median. Of the fourteen published sets and 25 synthetic captures, photographs that
// are in order have up to 1.5 times it; one with a smudge 13, of another sample 25 to 38, in
// which the sample was moved by a millimetre 3.6. None of fewer than four: half of them would be.
std::vector<size_t> OddViews(const std::vector<double>& losses);

}  // namespace glint
