#include "fitting/render/render_environment.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "base/reflectance/texel_at.h"
#include "tests/fitting/render/random_scene.h"

namespace glint {
namespace {

EnvironmentLighting Window() {
  EnvironmentLighting environment;
  environment.radiance_rgb.assign(9, {0.02, 0.01, 0.03});
  environment.radiance_rgb[0] = {0.1, 0.1, 0.2};
  return environment;
}

TEST(AddEnvironmentLighting, AddsWhatEachTexelReflects) {
  const SvbrdfMaps maps = RandomScene(3).Maps(6, 5);
  SamplePlane plane{6, 5, 60, 50};
  View view = DirView(0.3, -0.2);
  view.camera_in_sample_mm = {12, -8, 90};
  view.exposure = 1.5;
  const ReflectanceConvention convention;
  std::vector<float> rgb(3 * maps.texels(), 0.5f);
  AddEnvironmentLighting(Window(), maps, plane, view, convention, rgb.data());
  const size_t texel = 3 * 6 + 4;
  const TexelSvbrdf<double> svbrdf = TexelAt(maps, texel);
  view.light_rgb = {0, 0, 0};
  TexelGeometry<double> geometry =
      TexelGeometryInView(view, convention.falloff, plane.x_mm(4), plane.y_mm(3));
  EnvironmentReflection(svbrdf).AddTo(Window(), view.exposure, &geometry);
  double radiance[3];
  ShadeRadiance(svbrdf, geometry, convention, radiance);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_GT(radiance[c], 0);
    EXPECT_NEAR(rgb[c * maps.texels() + texel], 0.5 + radiance[c], 1e-6);
  }
}

TEST(AddEnvironmentLighting, TheSameForAnyNumberOfThreadsAndNothingFromTheDark) {
  const SvbrdfMaps maps = RandomScene(3).Maps(33, 17);
  const SamplePlane plane{33, 17, 2, 1};
  std::vector<float> one(3 * maps.texels()), three = one, none = one;
  AddEnvironmentLighting(Window(), maps, plane, DirView(0, 0), {}, one.data(), 1);
  AddEnvironmentLighting(Window(), maps, plane, DirView(0, 0), {}, three.data(), 3);
  AddEnvironmentLighting({}, maps, plane, DirView(0, 0), {}, none.data(), 1);
  EXPECT_EQ(one, three);
  EXPECT_EQ(none, std::vector<float>(3 * maps.texels()));
}

TEST(AddEnvironmentLighting, RefusesMapsOfAnotherSize) {
  const SvbrdfMaps maps = RandomScene(3).Maps(4, 4);
  std::vector<float> rgb(3 * maps.texels());
  EXPECT_THROW(AddEnvironmentLighting(Window(), maps, SamplePlane{5, 4, 1, 1}, {}, {}, rgb.data()),
               std::invalid_argument);
}

}  // namespace
}  // namespace glint
