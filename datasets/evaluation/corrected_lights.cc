#include "datasets/evaluation/corrected_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/contract/errors.h"
#include "pipeline/contract/manifest.h"

namespace glint {
namespace {

double AngleDeg(const Vec3d& a, const Vec3d& b) {
  const Vec3d cross{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                    a[0] * b[1] - a[1] * b[0]};
  const double sine = std::hypot(cross[0], cross[1], cross[2]);
  const double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return std::atan2(sine, cosine) * 180 / std::numbers::pi;
}

}  // namespace

LightAngles CompareLights(const PlannedViews& planned, const std::filesystem::path& fit_manifest) {
  const Manifest manifest = ReadManifest(fit_manifest);
  const Json corrections = manifest.data.value("corrections", Json::array());
  LightAngles angles;
  for (size_t i = 0; i < planned.views.size(); ++i) {
    Vec3d light = planned.views[i].light_in_sample_mm;
    for (const Json& correction : corrections) {
      if (RequireString(fit_manifest, correction, "corrections[]", "name") != ViewName(i)) continue;
      const auto offset_mm =
          RequireNumbers(fit_manifest, correction, "corrections[]", "light_offset_mm", 3);
      for (size_t k = 0; k < 3; ++k) light[k] += offset_mm[k];
    }
    const double off_deg = AngleDeg(light, planned.taken[i].light_in_sample_mm);
    angles.mean_deg += off_deg / static_cast<double>(planned.views.size());
    angles.worst_deg = std::max(angles.worst_deg, off_deg);
  }
  return angles;
}

}  // namespace glint
