#include <algorithm>
#include <cmath>

#include "fitting/estimator/estimator.h"

namespace glint {
namespace {

constexpr float kDark = 0.004f, kClipped = 0.99f;
constexpr double kTiltWeight = 1.0;  // a share of usable texels is worth as much as a cosine

// Share of the texels that say something.
double UsableShare(const Photograph& photograph) {
  const size_t texels = photograph.mask.size();
  double usable = 0;
  for (size_t i = 0; i < texels; ++i) {
    const float g = photograph.rgb[texels + i];
    const bool clipped = photograph.ldr && g >= kClipped;
    if (photograph.mask[i] >= 0.5f && g > kDark && !clipped) usable += 1;
  }
  return usable / static_cast<double>(std::max<size_t>(1, texels));
}

double TopCosine(const View& view) {
  const Vec3d& c = view.camera_in_sample_mm;
  return c[2] / std::max(1e-12, std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]));
}

}  // namespace

size_t BestStartingPhotograph(const PhotographSet& set) {
  size_t best = 0;
  double most = -1e300;
  for (size_t i = 0; i < set.photographs.size(); ++i) {
    const Photograph& photograph = set.photographs[i];
    const double worth = UsableShare(photograph) + kTiltWeight * TopCosine(photograph.view);
    if (worth > most) {
      most = worth;
      best = i;
    }
  }
  return best;
}

}  // namespace glint
