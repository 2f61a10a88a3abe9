// How improbable a metalness is, given what a texel reflects: nothing of metal reflects 5 %,
// nothing else a half.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace glint {

// What tells dielectrics from metals.
struct KindLook {
  float f0 = 0;       // mean of the channels
  float chroma = 0;   // root of the sum of the channels' squared departures from it, relative
  float diffuse = 0;  // mean of the channels, with the weight of the diffuse lobe
};
KindLook KindLookOf(const std::array<float, 3>& diffuse, const std::array<float, 3>& specular);

// The negative logarithm of the prior times the likelihood of a look, up to a constant.
//
// Of metalness m a texel is a mixture by area: F0 = (1 − m)·F0 of a dielectric + m·F0 of a metal,
// each log-normal (base/reflectance/material_kinds.h), its highlight is coloured if that is that
// of a metal that is, as half of them are, and its diffuse light is the dielectric's.
class KindCosts {
 public:
  // `metal_share`: prior share of metals, above 0 and below 1.
  KindCosts(const std::vector<double>& metalnesses, double metal_share);

  // Of the metalness of that index.
  float At(size_t metalness, const KindLook& look) const {
    const Row& row = rows_[metalness];
    return row.by_f0[StepOf(std::sqrt(look.f0))] +
           row.by_chroma[StepOf(look.chroma / kMostChroma)] + row.by_diffuse * look.diffuse;
  }

 private:
  static constexpr size_t kSteps = 256;          // of the root of F0, and of the chroma
  static constexpr float kMostChroma = 2.4495f;  // √6: two channels are black
  static size_t StepOf(float share) {
    return static_cast<size_t>(std::min(1.0f, std::max(0.0f, share)) * (kSteps - 1) + 0.5f);
  }
  struct Row {
    std::array<float, kSteps> by_f0;  // with what depends on nothing
    std::array<float, kSteps> by_chroma;
    float by_diffuse;
  };
  std::vector<Row> rows_;
};

}  // namespace glint
