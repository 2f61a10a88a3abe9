// A sample's specular lobes (convention.h) as the formulas take them. Without the standard library:
// the vector kernels include it.
#pragma once

namespace glint {

// The shape of a lobe (convention.h): how far its tails reach, and in which direction of the sample
// it is wider.
template <class S>
struct LobeShape {
  int exponent = 2;  // γ
  S stretch = S(1);  // √(γ − 1)
  bool anisotropic = false;
  S direction[2] = {S(1), S(0)};  // g: unit, in the sample's plane
  S ratio = S(1), inverse_ratio = S(1);

  // What h has along g counts 1/ratio as much, what it has across ratio times:
  //   ratio·sin² + (1/ratio − ratio)·along².
  [[gnu::always_inline]] S along_weight() const { return inverse_ratio - ratio; }
};

// Their shares of S and what multiplies the roughness map in them; LobeMixOf() (brdf.h) makes it.
// Where there are not two the second counts for nothing.
template <class S>
struct LobeMix {
  bool two = false;
  S share[2] = {1, 0};
  S scale[2] = {1, 1};
  LobeShape<S> shape;
  S coat_f0 = 0;  // of the second lobe, where it is a coat's; 0: it has the specular map's

  // Always inlined: the linker must not take them from code compiled for another instruction set.
  [[gnu::always_inline]] bool coat() const { return coat_f0 > S(0); }
  // The share of the lobes that have the specular map's F0.
  [[gnu::always_inline]] S mapped() const { return coat() ? share[0] : S(1); }
};

}  // namespace glint
