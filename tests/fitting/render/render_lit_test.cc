#include "fitting/render/render_lit.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/reflectance/brdf.h"
#include "base/reflectance/texel_at.h"
#include "fitting/render/renderer.h"

namespace glint {
namespace {

// The renderer of whole views and the geometry of single texels know the same light.
TEST(RenderLit, AgreesWithSingleTexels) {
  SvbrdfMaps maps(9, 7);
  for (size_t t = 0; t < maps.texels(); ++t) {
    maps.plane(kNormalZ)[t] = 1;
    maps.plane(kRoughness)[t] = 0.2f + 0.01f * static_cast<float>(t % 11);
    for (int c = 0; c < 3; ++c) {
      maps.plane(kDiffuseR + c)[t] = 0.1f + 0.02f * static_cast<float>(c);
      maps.plane(kSpecularR + c)[t] = 0.05f;
    }
  }
  const SamplePlane plane{9, 7, 90, 70};
  ReflectanceConvention convention;
  convention.falloff = LightFalloff::kInverseSquare;
  View view;
  view.camera_in_sample_mm = {10, -40, 200};
  view.light_in_sample_mm = {25, -30, 210};
  view.light_rgb = {6e4, 5e4, 4e4};
  view.ambient_rgb = {0.1, 0.2, 0.3};
  view.exposure = 1.3;
  view.beam = {0.5, -0.8};
  std::vector<float> rendered(3 * maps.texels());
  RenderLit(maps, plane, view, convention, rendered.data(), 2);
  for (size_t t = 0; t < maps.texels(); ++t) {
    double radiance[3];
    ShadeRadiance(TexelAt(maps, t),
                  TexelGeometryInView<double>(view, convention.falloff,
                                              plane.x_mm(static_cast<int>(t) % maps.width),
                                              plane.y_mm(static_cast<int>(t) / maps.width)),
                  convention, radiance);
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(rendered[c * maps.texels() + t], radiance[c], 1e-5 * radiance[c]) << t;
    }
  }
}

// Without a beam it is the fused renderer's picture, bit by bit.
TEST(RenderLit, WithoutABeamIsRenderView) {
  SvbrdfMaps maps(5, 4);
  for (size_t t = 0; t < maps.texels(); ++t) {
    maps.plane(kNormalZ)[t] = 1;
    maps.plane(kRoughness)[t] = 0.3f;
    maps.plane(kDiffuseG)[t] = 0.4f;
  }
  const SamplePlane plane{5, 4, 2, 2};
  const ReflectanceConvention convention;
  std::vector<float> lit(3 * maps.texels()), plain(3 * maps.texels());
  RenderLit(maps, plane, DirView(0.3, 0.1), convention, lit.data());
  RenderView(maps, plane, DirView(0.3, 0.1), convention, plain.data());
  EXPECT_EQ(lit, plain);
}

}  // namespace
}  // namespace glint
