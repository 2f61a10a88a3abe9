#include "datasets/synth/environment_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/errors/errors.h"
#include "base/images/image.h"
#include "base/reflectance/brdf.h"
#include "datasets/procedural/material.h"
#include "tests/support/data_folder.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
constexpr double kPi = std::numbers::pi;

SvbrdfMaps FlatMaps(int size, float diffuse, float specular, float roughness) {
  SvbrdfMaps maps(size, size);
  std::fill(maps.plane(kNormalZ).begin(), maps.plane(kNormalZ).end(), 1.0f);
  for (int c = 0; c < 3; ++c) {
    std::fill(maps.plane(kDiffuseR + c).begin(), maps.plane(kDiffuseR + c).end(), diffuse);
    std::fill(maps.plane(kSpecularR + c).begin(), maps.plane(kSpecularR + c).end(), specular);
  }
  std::fill(maps.plane(kRoughness).begin(), maps.plane(kRoughness).end(), roughness);
  return maps;
}

std::vector<float> Reflected(const EnvironmentLight& environment, const SvbrdfMaps& maps) {
  const auto convention = ReflectanceConvention::Dir2019();
  const SamplePlane plane{maps.width, maps.height, 2, 2, convention.sampling};
  std::vector<float> rgb(3 * maps.texels(), 0.0f);
  AddEnvironment(environment, maps, plane, DirView(0, 0), convention, rgb.data(), 1);
  return rgb;
}

// Relative RMS difference.
double Difference(const std::vector<float>& a, const std::vector<float>& b) {
  double squares = 0, sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    squares += (a[i] - b[i]) * static_cast<double>(a[i] - b[i]);
    sum += static_cast<double>(b[i]) * b[i];
  }
  return std::sqrt(squares / sum);
}

TEST(ConstantEnvironment, LightsAPlaneWithPi) {
  for (const int rings : {1, 3, kEnvironmentRings, 40}) {
    for (const double value : ConstantEnvironment(rings).PlaneIrradiance()) {
      EXPECT_NEAR(value, kPi, 1e-9) << rings;
    }
  }
}

TEST(ConstantEnvironment, IsReflectedByAlbedo) {
  const EnvironmentLight white = ConstantEnvironment();
  // What a second plane with more diffuse albedo reflects more is the albedo's difference: the
  // model's Fresnel term reflects at the horizon even without specular albedo.
  const auto lit = Reflected(white, FlatMaps(4, 0.9f, 0, 1));
  const auto black = Reflected(white, FlatMaps(4, 0, 0, 1));
  for (size_t i = 0; i < lit.size(); ++i) {
    EXPECT_NEAR(lit[i] - black[i], 0.9, 1e-4);
    EXPECT_LT(black[i], 0.06);
  }
}

TEST(AddEnvironment, IsPreciseAgainstAFinerQuadrature) {
  const SvbrdfMaps maps = MakeMaterial("leather", 12, 48, 48);
  const auto coarse = Reflected(ConstantEnvironment(), maps);
  const auto fine = Reflected(ConstantEnvironment(40), maps);
  EXPECT_LT(Difference(coarse, fine), 0.01);
  EXPECT_GT(Difference(coarse, fine), 1e-5);  // two quadratures, not one
}

TEST(AddEnvironment, ALampShinesFromItsPixel) {
  const test::TemporaryFolder folder;
  Image map(64, 32, {"R", "G", "B"});
  // Polar angle 8.5/32·180° = 47.8°, azimuth 16.5/64·360° = 92.8°; and one below the horizon.
  map.channel(0)[8 * 64 + 16] = 1000;
  map.channel(1)[20 * 64 + 16] = 1000;
  const fs::path file = folder.path() / "lamp.exr";
  WriteExr(file, map);
  const EnvironmentLight lamp = ReadEnvironment(file);
  ASSERT_EQ(lamp.lights.size(), 1u);
  const Vec3d& d = lamp.lights[0].direction;
  EXPECT_NEAR(std::acos(d[2]) * 180 / kPi, 47.8, 0.1);
  EXPECT_NEAR(std::atan2(d[1], d[0]) * 180 / kPi, 92.8, 0.1);
  EXPECT_EQ(lamp.lights[0].irradiance_rgb[1], 0);
}

TEST(ReadEnvironment, WrongMapsAreUserErrors) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(ReadEnvironment(folder.path() / "none.hdr"), UserError);
  const Image black(8, 4, {"R", "G", "B"});
  WriteExr(folder.path() / "black.exr", black);
  EXPECT_THROW(ReadEnvironment(folder.path() / "black.exr"), UserError);
  WritePng(folder.path() / "picture.png", black);
  EXPECT_THROW(ReadEnvironment(folder.path() / "picture.png"), UserError);
}

TEST(ReadEnvironment, RealMapsAreReadAndPrecise) {
  const fs::path data = test::DataFolder();
  if (!fs::exists(data / "env")) GTEST_SKIP() << "no environment maps";
  const SvbrdfMaps maps = MakeMaterial("leather", 12, 32, 32);
  for (const std::string name : {"city.hdr", "lobby.hdr", "photo_studio_loft_hall_1k.exr"}) {
    const auto coarse = Reflected(ReadEnvironment(data / "env" / name), maps);
    const auto fine = Reflected(ReadEnvironment(data / "env" / name, 40), maps);
    const double difference = Difference(coarse, fine);
    RecordProperty(name, std::to_string(difference));
    EXPECT_LT(difference, 0.03) << name;
  }
}

}  // namespace
}  // namespace glint
