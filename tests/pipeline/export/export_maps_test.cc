#include "pipeline/export/export_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "pipeline/export/metallic.h"
#include "tests/support/process.h"

namespace glint {
namespace {

const MapPicture& Named(const std::vector<MapPicture>& pictures, const std::string& name) {
  const auto found = std::find_if(pictures.begin(), pictures.end(),
                                  [&](const MapPicture& picture) { return picture.name == name; });
  if (found == pictures.end()) throw std::runtime_error("no picture " + name);
  return *found;
}

constexpr int kSize = 16;  // smaller pictures are refused as photographs

SvbrdfMaps Uniform() {
  SvbrdfMaps maps(kSize, kSize);
  const float planes[] = {0.6f, 0.8f, 0.0f, 0.2140411f, 0.5f, 1.0f, 0.04f, 0.04f, 0.04f, 0.3f};
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    std::fill(maps.plane(p).begin(), maps.plane(p).end(), planes[p]);
  }
  return maps;
}

// Values of IEC 61966-2-1: 0.5 encoded is 0.21404114 linear.
TEST(SrgbTest, AgreesWithTheStandard) {
  EXPECT_NEAR(SrgbFromLinear(0.21404114f), 0.5, 1e-6);
  EXPECT_NEAR(SrgbFromLinear(0.001f), 0.01292, 1e-7);
  EXPECT_EQ(SrgbFromLinear(-1.0f), 0.0f);
  EXPECT_NEAR(SrgbFromLinear(2.0f), 1.0f, 1e-6);
}

TEST(ExportTest, EncodesEachMapAsItsNameSays) {
  const auto pictures = MapPictures(Uniform(), ExportOptions());
  ASSERT_EQ(pictures.size(), 4u);
  EXPECT_NEAR(Named(pictures, "normal").image.samples[0], 0.8, 1e-6);
  EXPECT_NEAR(Named(pictures, "normal").image.channel(1)[0], 0.9, 1e-6);
  EXPECT_NEAR(Named(pictures, "normal").image.channel(2)[0], 0.5, 1e-6);
  EXPECT_NEAR(Named(pictures, "diffuse").image.samples[0], 0.5, 1e-5);
  EXPECT_NEAR(Named(pictures, "roughness").image.samples[0], 0.3, 1e-7);
  EXPECT_EQ(Named(pictures, "roughness").image.channels.size(), 1u);
}

TEST(ExportTest, HeightsAreBetweenItsLowestAndHighestPoint) {
  HeightField field{2, 2, 1, 1, {-0.5f, 0.25f, 0.0f, 0.5f}};
  std::array<double, 2> range_mm;
  const MapPicture picture = HeightPicture(field, &range_mm);
  EXPECT_NEAR(range_mm[0], -0.5, 1e-6);
  EXPECT_NEAR(range_mm[1], 0.5, 1e-6);
  for (size_t i = 0; i < 4; ++i) {
    const double h = range_mm[0] + picture.image.samples[i] * (range_mm[1] - range_mm[0]);
    EXPECT_NEAR(h, field.height_mm[i], 1e-6);
  }
  const HeightField flat{2, 2, 1, 1, {0, 0, 0, 0}};
  for (const float h : HeightPicture(flat, &range_mm).image.samples) EXPECT_EQ(h, 0.0f);
}

TEST(ExportTest, MinusYMirrorsGreenOnly) {
  ExportOptions options;
  options.normal_y = "-";
  const auto pictures = MapPictures(Uniform(), options);
  EXPECT_NEAR(Named(pictures, "normal").image.samples[0], 0.8, 1e-6);
  EXPECT_NEAR(Named(pictures, "normal").image.channel(1)[0], 0.1, 1e-6);
  EXPECT_EQ(Named(pictures, "normal").encoding, "normal -Y");
}

// What a metal-roughness material can be comes back: dielectrics and metals.
TEST(MetallicTest, RecoversMetalRoughnessMaterials) {
  const std::array<float, 3> base = {0.8f, 0.5f, 0.2f};
  const BaseColorMetallic plastic = ToBaseColorMetallic(base, {0.04f, 0.04f, 0.04f});
  EXPECT_NEAR(plastic.metallic, 0, 1e-3);
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(plastic.base_color[c], base[c], 1e-3);
  const BaseColorMetallic gold = ToBaseColorMetallic({0, 0, 0}, base);
  EXPECT_NEAR(gold.metallic, 1, 1e-3);
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(gold.base_color[c], base[c], 1e-3);
}

TEST(ExportTest, WritesBothDepthsWithinHalfAStep) {
  const test::TemporaryFolder folder;
  const auto input = folder.path() / "input";
  std::ofstream(input) << "x";
  ExportOptions options;
  OptionSet set;
  AddExportOptions(&set, &options);
  Stage stage(folder.path() / "export", {"export", 1}, set, CommonOptions(), {input});
  const Json files = WriteMapPictures(MapPictures(Uniform(), options), options, &stage);
  stage.Commit({{"maps", files}}, {});
  EXPECT_EQ(files.size(), 8u);
  for (const Json& entry : files) {
    const Photo photo = ReadPhoto(folder.path() / "export" / entry["file"].get<std::string>());
    EXPECT_EQ(photo.bits, entry["bits"].get<int>());
    if (entry["map"] != "roughness") continue;
    EXPECT_NEAR(photo.image.samples[0], 0.3, 0.5 / (std::pow(2.0, photo.bits) - 1) + 1e-7);
  }
}

}  // namespace
}  // namespace glint
