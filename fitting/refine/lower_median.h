#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace glint {

// The lower of the two in the middle of an even number; 0 if there is none. Reorders `values`.
inline float LowerMedian(std::vector<float>* values) {
  if (values->empty()) return 0;
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>((values->size() - 1) / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

}  // namespace glint
