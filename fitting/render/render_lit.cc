#include "fitting/render/render_lit.h"

#include <cmath>
#include <vector>

#include "fitting/render/renderer.h"

namespace glint {

void RenderLit(const SvbrdfMaps& maps, const SamplePlane& plane, const View& view,
               const ReflectanceConvention& convention, float* rgb_planar, int threads) {
  View even = view, unlit = view;
  even.beam = unlit.beam = {0, 0};
  if (view.beam == even.beam) {
    RenderView(maps, plane, even, convention, rgb_planar, threads);
    return;
  }
  // Light adds up: the flash's share is scaled, that of the surroundings is not.
  even.ambient_rgb = {0, 0, 0};
  unlit.light_rgb = {0, 0, 0};
  const size_t texels = maps.texels();
  std::vector<float> ambient(3 * texels);
  RenderView(maps, plane, even, convention, rgb_planar, threads);
  RenderView(maps, plane, unlit, convention, ambient.data(), threads);
  const Vec3d& light = view.light_in_sample_mm;
  for (int row = 0; row < plane.height; ++row) {
    for (int column = 0; column < plane.width; ++column) {
      const double tangents[2] = {(plane.x_mm(column) - light[0]) / light[2],
                                  (plane.y_mm(row) - light[1]) / light[2]};
      const auto gain =
          static_cast<float>(std::exp(view.beam[0] * tangents[0] + view.beam[1] * tangents[1]));
      const size_t texel =
          static_cast<size_t>(row) * static_cast<size_t>(plane.width) + static_cast<size_t>(column);
      for (size_t c = 0; c < 3; ++c) {
        float& radiance = rgb_planar[c * texels + texel];
        radiance = gain * radiance + ambient[c * texels + texel];
      }
    }
  }
}

}  // namespace glint
