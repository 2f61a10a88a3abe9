// A sample's specular lobes (convention.h) as the formulas take them. Without the standard library:
// the vector kernels include it.
#pragma once

namespace glint {

// How far a lobe's tails reach (convention.h): γ, and √(γ − 1).
template <class S>
struct LobeTail {
  int exponent = 2;
  S stretch = S(1);
};

// Their shares of S and what multiplies the roughness map in them; LobeMixOf() (brdf.h) makes it.
// Where there are not two the second counts for nothing.
template <class S>
struct LobeMix {
  bool two = false;
  S share[2] = {1, 0};
  S scale[2] = {1, 1};
  LobeTail<S> tail;
  S coat_f0 = 0;  // of the second lobe, where it is a coat's; 0: it has the specular map's

  // Always inlined: the linker must not take them from code compiled for another instruction set.
  [[gnu::always_inline]] bool coat() const { return coat_f0 > S(0); }
  // The share of the lobes that have the specular map's F0.
  [[gnu::always_inline]] S mapped() const { return coat() ? share[0] : S(1); }
};

}  // namespace glint
