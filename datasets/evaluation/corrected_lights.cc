#include "datasets/evaluation/corrected_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/formats/manifest.h"
#include "fitting/view_correction/corrections_json.h"

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
  const auto corrections = ReadCorrections(fit_manifest, manifest.data);
  const SharedLight shared_light = ReadSharedLight(fit_manifest, manifest.data);
  LightAngles angles;
  for (size_t i = 0; i < planned.views.size(); ++i) {
    const auto found = corrections.find(ViewName(i));
    View view = WithSharedLight(planned.views[i], shared_light);
    if (found != corrections.end()) view = CorrectedView(view, found->second);
    const Vec3d& light = view.light_in_sample_mm;
    const double off_deg = AngleDeg(light, planned.taken[i].light_in_sample_mm);
    angles.mean_deg += off_deg / static_cast<double>(planned.views.size());
    angles.worst_deg = std::max(angles.worst_deg, off_deg);
  }
  return angles;
}

}  // namespace glint
