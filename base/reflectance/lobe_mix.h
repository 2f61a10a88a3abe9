// A sample's specular lobes (convention.h) as the formulas take them. Without the standard library:
// the vector kernels include it.
#pragma once

namespace glint {

// Their shares of S and what multiplies the roughness map in them; LobeMixOf() (brdf.h) makes it.
// Where there are not two the second counts for nothing.
template <class S>
struct LobeMix {
  bool two = false;
  S share[2] = {1, 0};
  S scale[2] = {1, 1};
};

}  // namespace glint
