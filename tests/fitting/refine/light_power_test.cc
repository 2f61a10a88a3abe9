#include "fitting/refine/light_power.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/reflectance/brdf.h"
#include "base/reflectance/svbrdf_deviations.h"
#include "base/reflectance/texel_at.h"
#include "fitting/refine/refine.h"
#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

// A flash beside the lens: no rim to speak of.
TEST(SetUnderPower, MapsLookTheSameUnderTheOtherLight) {
  SvbrdfMaps maps = test::QuarteredMaps(8, 3);
  const SvbrdfMaps before = maps;
  std::vector<float> sigma(kConfidencePlanes * maps.texels(), 1.0f);
  constexpr double kPower = 1.6;
  for (const DiffuseWeight weight : {DiffuseWeight::kOne, DiffuseWeight::kOneMinusSpecular}) {
    maps = before;
    SetUnderPower(kPower, weight, &maps, &sigma);
    const double direction[3] = {0.1, 0.2, 0.97}, ambient[3] = {0, 0, 0};
    for (size_t t = 0; t < maps.texels(); ++t) {
      double was[3], is[3];
      const double one[3] = {1, 1, 1}, stronger[3] = {kPower, kPower, kPower};
      ShadeRadiance(TexelAt(before, t), MakeTexelGeometry(direction, direction, one, ambient),
                    {weight}, was);
      ShadeRadiance(TexelAt(maps, t), MakeTexelGeometry(direction, direction, stronger, ambient),
                    {weight}, is);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(is[c], was[c], 5e-3 * was[c]);
    }
  }
  EXPECT_NEAR(sigma[kSigmaDiffuseR * maps.texels()], 1 / (kPower * kPower), 1e-6);
  EXPECT_EQ(sigma[kSigmaRoughness * maps.texels()], 1);
}

// Photographs under a light twice as strong as stated: dielectrics seem to reflect 8 %.
TEST(Refine, DielectricsTellTheLightsPower) {
  SvbrdfMaps truth = test::QuarteredMaps(32, 26);
  for (int p = kSpecularR; p <= kSpecularB; ++p) {
    for (float& f0 : truth.plane(p)) f0 = 0.04f;
  }
  for (const double power : {0.5, 1.0, 2.0}) {
    test::SyntheticScene scene = test::Photograph(truth, 8);
    for (auto& photograph : scene.photographs) {
      for (float& radiance : photograph) radiance *= static_cast<float>(power);
    }
    RefineOptions options;
    options.kinds.light_power_spread = 0.5;
    const SvbrdfMaps start = test::DisturbedMaps(truth, 0.5f, 27);
    const double found = Refine(scene.Problem(), start, options, 1).summary.light_power;
    EXPECT_NEAR(found / power, 1, 0.2) << power;
  }
}

}  // namespace
}  // namespace glint
