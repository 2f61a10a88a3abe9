#include "fitting/render/render_environment.h"

#include <cstddef>

#include "base/parallel/parallel.h"
#include "base/reflectance/texel_at.h"
#include "fitting/render/check_sizes.h"

namespace glint {

void AddEnvironmentLighting(const EnvironmentLighting& environment, const SvbrdfMaps& maps,
                            const SamplePlane& plane, const View& view,
                            const ReflectanceConvention& convention, float* rgb_planar,
                            int threads) {
  kernel::CheckSizes(maps, plane);
  if (!environment.any()) return;
  View unlit = view;
  unlit.light_rgb = unlit.ambient_rgb = {0, 0, 0};
  ForEachPiece(plane.height, threads, [&](int row) {
    for (int column = 0; column < plane.width; ++column) {
      const size_t texel = static_cast<size_t>(row) * plane.width + static_cast<size_t>(column);
      const TexelSvbrdf<double> svbrdf = TexelAt(maps, texel);
      TexelGeometry<double> geometry = TexelGeometryInView<double>(
          unlit, convention.falloff, plane.x_mm(column), plane.y_mm(row));
      EnvironmentReflection(svbrdf).AddTo(environment, view.exposure, &geometry);
      for (int c = 0; c < 3; ++c) {
        rgb_planar[static_cast<size_t>(c) * maps.texels() + texel] +=
            static_cast<float>(AmbientRadiance(svbrdf, geometry, convention, c));
      }
    }
  });
}

}  // namespace glint
