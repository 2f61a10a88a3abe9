// Writes maps, reads them again and renders them, by installed headers and libraries alone.
#include <cmath>
#include <cstdio>
#include <vector>

#include "base/formats/svbrdf_file.h"
#include "base/reflectance/brdf.h"
#include "fitting/render/renderer.h"

int main(int count, char** arguments) {
  using namespace glint;
  if (count != 2) return 2;
  SvbrdfMaps maps(4, 4);
  for (size_t i = 0; i < maps.texels(); ++i) {
    maps.plane(kNormalZ)[i] = 1;
    maps.plane(kRoughness)[i] = 0.4f;
    for (int c = 0; c < 3; ++c) {
      maps.plane(kDiffuseR + c)[i] = 0.3f;
      maps.plane(kSpecularR + c)[i] = 0.04f;
    }
  }
  const ReflectanceConvention convention = ReflectanceConvention::Photograph();
  WriteSvbrdf(arguments[1], maps, convention);
  maps = ReadSvbrdf(arguments[1]);

  const SamplePlane plane{4, 4, 100.0, 100.0};
  View view;
  view.camera_in_sample_mm = {20, 10, 300};
  view.light_in_sample_mm = {-40, 30, 280};
  view.light_rgb = {1e5, 1e5, 1e5};
  std::vector<float> image(3 * maps.texels());
  RenderView(maps, plane, view, convention, image.data());

  const TexelSvbrdf<double> texel{{0, 0, 1}, {.3, .3, .3}, {.04, .04, .04}, .4};
  double expected[3];
  ShadeRadiance(texel, TexelGeometryInView(view, convention.falloff, plane.x_mm(2), plane.y_mm(1)),
                convention, expected);
  std::printf("rendered %.6f, by the formula %.6f\n", image[4 + 2], expected[0]);
  return std::abs(image[4 + 2] - expected[0]) < 1e-3 * expected[0] ? 0 : 1;
}
