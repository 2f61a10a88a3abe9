// Radial resampling kernels, tabulated over the squared radius.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace glint {

// What a texel gathers, as a function of the distance in texels:
//   kSharp    Robidoux' sharper cubic (B 0.2620, C 0.3690): response 0.99 at 1/4, 0.58 at 1/2 cycle
//             per texel (Nyquist), below 0.006 from 0.9 on, radius 2. The default.
//   kSoft     Robidoux' cubic (B 0.3782, C 0.3109): 0.92, 0.49, below 0.005, radius 2; least
//   ringing. kLanczos  jinc windowed by jinc, three lobes: 1.02, 0.46, below 0.01 from 0.7 on,
//   radius 3.24;
//             the best low-pass, at 2.6 times the work and with wider saturation margins.
// Cubics: Mitchell & Netravali 1988; as radial filters: N. Robidoux, in ImageMagick's elliptical
// weighted average resampling. The responses are Hankel transforms of the kernels.
enum class FilterKind { kSharp, kSoft, kLanczos };

std::optional<FilterKind> FilterFromName(std::string_view name);  // "sharp", "soft", "lanczos"

class FilterKernel {
 public:
  explicit FilterKernel(FilterKind kind);

  double radius() const { return radius_; }

  // Weight at squared radius `r2` in [0, radius²); 0 beyond.
  float Weight(float r2) const {
    const float position = r2 * steps_per_r2_;
    const int i = static_cast<int>(position);
    if (i >= kSteps) return 0;
    const float t = position - static_cast<float>(i);
    return table_[i] + t * (table_[i + 1] - table_[i]);
  }

 private:
  static constexpr int kSteps = 4096;
  double radius_;
  float steps_per_r2_;
  std::vector<float> table_;  // kSteps + 1 values, evenly spaced in r²
};

}  // namespace glint
