#include "fitting/refine/gather.h"

#include <algorithm>
#include <optional>

#include "fitting/reflectance/texel_at.h"

namespace glint {

void GatherObservations(const RefineProblem& problem, const SvbrdfMaps& maps, size_t texel,
                        std::span<const int> views, TexelObservations* observations) {
  const size_t texels = static_cast<size_t>(problem.plane.width) * problem.plane.height;
  const double x = problem.plane.x_mm(static_cast<int>(texel % problem.plane.width));
  const double y = problem.plane.y_mm(static_cast<int>(texel / problem.plane.width));
  std::optional<RoomReflection> reflection;
  if (problem.room.any()) reflection.emplace(TexelAt(maps, texel));
  observations->Clear();
  for (const int v : views) {
    const RefineView& view = problem.views[static_cast<size_t>(v)];
    if (!(view.mask[texel] >= 0.5f)) continue;
    const std::span<const float> target = view.deblurred.empty() ? view.rgb : view.deblurred;
    double radiance[3];
    bool clipped[3];
    for (int c = 0; c < 3; ++c) {
      radiance[c] = std::max(static_cast<double>(target[c * texels + texel]), 0.0);
      clipped[c] = view.ldr && static_cast<double>(view.rgb[c * texels + texel]) >= kClipped;
    }
    TexelGeometry<double> geometry =
        TexelGeometryInView<double>(view.view, problem.convention.falloff, x, y);
    if (reflection) reflection->AddTo(problem.room, view.view.exposure, &geometry);
    observations->Add(geometry, radiance, clipped);
  }
  observations->Finish();
}

}  // namespace glint
