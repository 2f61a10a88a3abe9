#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/contract/errors.h"
#include "pipeline/contract/image.h"
#include "pipeline/contract/svbrdf_file.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::HasSubstr;

SvbrdfMaps Ramp(int width, int height) {
  SvbrdfMaps maps(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(width);
      maps.at(kNormalX, y, x) = 0.6f * (u - 0.5f);
      maps.at(kNormalZ, y, x) = std::sqrt(1 - 0.36f * (u - 0.5f) * (u - 0.5f));
      for (int p = kDiffuseR; p <= kRoughness; ++p) maps.at(p, y, x) = u;
    }
  }
  return maps;
}

TEST(SvbrdfFile, RoundTripKeepsMapsAndConvention) {
  const test::TemporaryFolder folder;
  const SvbrdfMaps maps = Ramp(24, 16);
  WriteSvbrdf(folder / "s.exr", maps, ReflectanceConvention::Dir2019());
  ReflectanceConvention convention;
  EXPECT_EQ(ReadSvbrdf(folder / "s.exr", &convention).planes, maps.planes);
  EXPECT_EQ(convention, ReflectanceConvention::Dir2019());
}

TEST(SvbrdfFile, MissingChannelsAndWildValuesAreNamed) {
  const test::TemporaryFolder folder;
  WriteExr(folder / "rgb.exr", Image(4, 4, {"R", "G", "B"}));
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadSvbrdf(folder / "rgb.exr"); }),
              HasSubstr("normal.X"));
  SvbrdfMaps maps = Ramp(4, 4);
  maps.at(kRoughness, 1, 1) = 7;
  WriteSvbrdf(folder / "wild.exr", maps, {});
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadSvbrdf(folder / "wild.exr"); }),
              HasSubstr("roughness.Y"));
}

TEST(ResampleSvbrdf, KeepsALinearRampAndUnitNormalsBothWays) {
  const SvbrdfMaps maps = Ramp(64, 32);
  for (const auto& [width, height] : {std::pair{16, 8}, std::pair{24, 12}, std::pair{128, 64}}) {
    // Texels that straddle a boundary are shared between two averages, which bends the ramp a
    // little.
    const double tolerance = 64 % width == 0 || width > 64 ? 1e-5 : 0.1 / width;
    const SvbrdfMaps resampled = ResampleSvbrdf(maps, width, height);
    for (int x = 2; x < width - 2; ++x) {
      EXPECT_NEAR(resampled.at(kDiffuseR, height / 2, x), (x + 0.5) / width, tolerance);
      const float nx = resampled.at(kNormalX, 0, x), nz = resampled.at(kNormalZ, 0, x);
      EXPECT_NEAR(nx * nx + nz * nz, 1, 1e-5);
    }
  }
}

}  // namespace
}  // namespace glint
