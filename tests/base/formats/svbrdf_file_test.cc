#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors/errors.h"
#include "base/formats/svbrdf_file.h"
#include "base/formats/svbrdf_rows.h"
#include "base/images/image.h"
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

// Every part of resampled maps is that part of the whole, larger or smaller.
TEST(SvbrdfRows, AreThoseOfTheResampledMaps) {
  const test::TemporaryFolder folder;
  SvbrdfMaps maps(12, 700);
  for (size_t i = 0; i < maps.planes.size(); ++i) {
    maps.planes[i] = 0.5f + 0.4f * std::sin(0.1f * static_cast<float>(i));
  }
  const ReflectanceConvention convention;
  WriteSvbrdf(folder / "a.exr", maps, convention);
  for (const auto& [width, height] :
       {std::pair{12, 700}, std::pair{5, 300}, std::pair{24, 1400}, std::pair{12, 7}}) {
    const SvbrdfMaps whole = ResampleSvbrdf(ReadSvbrdf(folder / "a.exr"), width, height);
    ResampledSvbrdf reader(folder / "a.exr", width, height);
    const int first = height / 3, rows = height / 2;
    const SvbrdfMaps part = reader.Read(first, rows);
    ASSERT_EQ(part.height, rows);
    for (int p = 0; p < kSvbrdfPlanes; ++p) {
      const auto from = whole.plane(p).begin() + static_cast<std::ptrdiff_t>(first) * width;
      EXPECT_TRUE(std::equal(part.plane(p).begin(), part.plane(p).end(), from)) << height << p;
    }
    EXPECT_EQ(reader.Read(0, height).planes, whole.planes) << height;
  }
}

}  // namespace
}  // namespace glint
