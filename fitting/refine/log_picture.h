// A photograph's log radiance, by which its detail is compared with that of others.
#pragma once

#include <vector>

#include "fitting/photographs/photographs.h"

namespace glint {

struct LogPicture {
  LogPicture(const Photograph& photograph, int width, int height);

  int width, height;
  std::vector<float> rgb;     // planar, log(I + 0.01); 0 where the photograph says nothing
  std::vector<float> usable;  // 1 or 0

  // Both over what is usable; elsewhere 0. By a Gaussian of that variance, texels²:
  std::vector<float> Blurred(double variance) const;
  // Of one plane, of such as `rgb`: what is left without a triangle filter kDetailReach wide.
  std::vector<float> DetailOf(std::vector<float> plane) const;
};

inline constexpr int kDetailReach = 14;  // texels each way: σ 6

// Mean of the three planes.
std::vector<float> Luminance(const std::vector<float>& planes);

}  // namespace glint
