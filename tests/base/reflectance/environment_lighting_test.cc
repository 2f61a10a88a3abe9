#include "base/reflectance/environment_lighting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace glint {
namespace {

TexelSvbrdf<double> Gloss(double roughness, double slope_x = 0, double slope_y = 0) {
  TexelSvbrdf<double> texel{};
  const double z = 1 / std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
  texel.normal[0] = slope_x * z;
  texel.normal[1] = slope_y * z;
  texel.normal[2] = z;
  for (double& f0 : texel.specular) f0 = 1;
  texel.roughness = roughness;
  return texel;
}

// The terms' values toward a direction: what a mirror shows.
EnvironmentHarmonics Toward(double x, double y, double z) {
  const double camera[3] = {-x, -y, z};
  EnvironmentHarmonics terms = EnvironmentReflection(Gloss(0)).Specular(camera);
  for (double& term : terms) term /= std::numbers::pi;
  return terms;
}

// Calls visit(direction, solid angle) for cells of the sphere between the polar angles.
void ForEachCell(double polar0, double polar1,
                 const std::function<void(const double d[3], double solid_angle)>& visit) {
  constexpr int kRings = 180, kSectors = 360;
  for (int i = 0; i < kRings; ++i) {
    const double polar = polar0 + (polar1 - polar0) * (i + 0.5) / kRings;
    for (int j = 0; j < kSectors; ++j) {
      const double azimuth = 2 * std::numbers::pi * (j + 0.5) / kSectors;
      const double d[3] = {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                           std::cos(polar)};
      visit(d, std::sin(polar) * (polar1 - polar0) / kRings * 2 * std::numbers::pi / kSectors);
    }
  }
}

TEST(EnvironmentLighting, TermsAreOrthogonalAndOfMeanSquareOne) {
  std::array<std::array<double, kEnvironmentTerms>, kEnvironmentTerms> products{};
  ForEachCell(0, std::numbers::pi, [&](const double d[3], double solid_angle) {
    const EnvironmentHarmonics terms = Toward(d[0], d[1], d[2]);
    for (size_t i = 0; i < kEnvironmentTerms; ++i) {
      for (size_t j = 0; j < kEnvironmentTerms; ++j) {
        products[i][j] += terms[i] * terms[j] * solid_angle / (4 * std::numbers::pi);
      }
    }
  });
  for (size_t i = 0; i < kEnvironmentTerms; ++i) {
    for (size_t j = 0; j < kEnvironmentTerms; ++j) {
      EXPECT_NEAR(products[i][j], i == j ? 1 : 0, 2e-3) << i << ", " << j;
    }
  }
}

TEST(EnvironmentLighting, TermsStandInTheUsualOrder) {
  const double third = 1 / std::sqrt(3.0);
  const EnvironmentHarmonics terms = Toward(0.6, 0.48, 0.64);
  EXPECT_NEAR(terms[0], 1, 1e-6);
  EXPECT_NEAR(terms[1] * third, 0.48, 1e-6);  // y, z, x
  EXPECT_NEAR(terms[2] * third, 0.64, 1e-6);
  EXPECT_NEAR(terms[3] * third, 0.6, 1e-6);
}

TEST(EnvironmentLighting, DiffuseIsTheIrradianceOfTheTexelsPlane) {
  const TexelSvbrdf<double> texel = Gloss(0.5, 0.3, -0.5);
  EnvironmentHarmonics irradiance{};
  ForEachCell(0, std::numbers::pi, [&](const double d[3], double solid_angle) {
    const double cosine = Dot(texel.normal, d);
    if (cosine <= 0) return;
    const EnvironmentHarmonics terms = Toward(d[0], d[1], d[2]);
    for (size_t j = 0; j < kEnvironmentTerms; ++j) irradiance[j] += terms[j] * cosine * solid_angle;
  });
  const EnvironmentHarmonics diffuse = EnvironmentReflection(texel).diffuse();
  for (size_t j = 0; j < kEnvironmentTerms; ++j) {
    // Degrees above 2 are left out: the fourth has 1/24 of the first's weight.
    EXPECT_NEAR(diffuse[j], irradiance[j], j < 9 ? 2e-3 : 0.45) << j;
  }
}

// π times the radiance that a perfect reflector of this roughness sends toward the camera.
EnvironmentHarmonics Reflected(const TexelSvbrdf<double>& texel, const double camera[3]) {
  const double none[3] = {0, 0, 0};
  EnvironmentHarmonics sums{};
  ForEachCell(0, std::numbers::pi / 2, [&](const double d[3], double solid_angle) {
    const TexelGeometry<double> geometry = MakeTexelGeometry(d, camera, none, none);
    double brdf[3];
    EvaluateBrdf(texel, geometry, {DiffuseWeight::kOne}, brdf);
    const double weight = std::numbers::pi * brdf[0] * d[2] * solid_angle;
    const EnvironmentHarmonics terms = Toward(d[0], d[1], d[2]);
    for (size_t j = 0; j < kEnvironmentTerms; ++j) sums[j] += weight * terms[j];
  });
  return sums;
}

TEST(EnvironmentLighting, SpecularIsWhatTheLobeReflects) {
  const double front[3] = {0, 0, 1};
  const double tilted[3] = {std::sin(0.5), 0, std::cos(0.5)};
  for (const double roughness : {0.25, 0.4, 0.7}) {
    const TexelSvbrdf<double> texel = Gloss(roughness);
    const EnvironmentReflection reflection(texel);
    const EnvironmentHarmonics seen = reflection.Specular(front), real = Reflected(texel, front);
    const EnvironmentHarmonics seen_tilted = reflection.Specular(tilted);
    const EnvironmentHarmonics real_tilted = Reflected(texel, tilted);
    for (size_t j = 0; j < kEnvironmentTerms; ++j) {
      EXPECT_NEAR(seen[j], real[j], 0.04) << roughness << ", " << j;
      // The mirrored lobe is no longer round.
      EXPECT_NEAR(seen_tilted[j], real_tilted[j], 0.8) << roughness << ", " << j;
    }
  }
}

TEST(EnvironmentLighting, AnEvenEnvironmentLightsLikeAnAmbientLight) {
  const EnvironmentLighting environment{{{0.1, 0.2, 0.3}}};
  View view;
  view.camera_in_sample_mm = view.light_in_sample_mm = {20, 10, 200};
  view.exposure = 2;
  View lit = view;
  lit.ambient_rgb = {0.1 * std::numbers::pi, 0.2 * std::numbers::pi, 0.3 * std::numbers::pi};
  TexelGeometry<double> by_environment = TexelGeometryInView(view, LightFalloff::kNone, 5.0, 5.0);
  const TexelGeometry<double> by_ambient = TexelGeometryInView(lit, LightFalloff::kNone, 5.0, 5.0);
  EnvironmentReflection(Gloss(0.1, 0.4)).AddTo(environment, view.exposure, &by_environment);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(by_environment.ambient[c], by_ambient.ambient[c], 1e-12);
    EXPECT_NEAR(by_environment.ambient_specular[c], by_ambient.ambient_specular[c], 1e-3);
    EXPECT_NEAR(environment.PlaneIrradiance()[static_cast<size_t>(c)],
                lit.ambient_rgb[static_cast<size_t>(c)], 1e-12);
  }
}

TEST(EnvironmentLighting, RadianceComesFromWhereTheTermsSay) {
  const EnvironmentLighting environment{{{0.2, 0.2, 0.2}, {0, 0, 0}, {0, 0, 0}, {0.1, 0, 0}}};
  EXPECT_NEAR(environment.RadianceFrom({1, 0, 0})[0], 0.2 + 0.1 * std::sqrt(3), 1e-12);
  EXPECT_NEAR(environment.RadianceFrom({-1, 0, 0})[0], 0.2 - 0.1 * std::sqrt(3), 1e-12);
  EXPECT_NEAR(environment.RadianceFrom({0, 0.6, 0.8})[0], 0.2, 1e-12);
  EXPECT_NEAR(environment.RadianceFrom({1, 0, 0})[1], 0.2, 1e-12);
}

TEST(EnvironmentLighting, SumsHaveAllTermsOfBoth) {
  EnvironmentLighting sum{{{1, 2, 3}}};
  sum.Add({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}});
  EXPECT_EQ(sum.radiance_rgb, (std::vector<Vec3d>{{2, 2, 3}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}));
  EXPECT_EQ(sum.degree(), 1);
  sum.Add({});
  EXPECT_EQ(sum.terms(), 4);
  EXPECT_FALSE(EnvironmentLighting{}.any());
}

}  // namespace
}  // namespace glint
