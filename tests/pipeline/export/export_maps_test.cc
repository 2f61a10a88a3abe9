#include "pipeline/export/export_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/colour/srgb.h"
#include "base/photos/photo.h"
#include "tests/pipeline/export/exported_material.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using test::kSize;

const MapPicture& Named(const std::vector<MapPicture>& pictures, const std::string& map) {
  const auto found = std::find_if(pictures.begin(), pictures.end(),
                                  [&](const MapPicture& picture) { return picture.map == map; });
  if (found == pictures.end()) throw std::runtime_error("no picture of " + map);
  return *found;
}

ExportedMaterial Uniform() {
  return test::MaterialOf(
      test::UniformMaps({0.6f, 0.8f, 0.0f, 0.2140411f, 0.5f, 1.0f, 0.04f, 0.04f, 0.04f, 0.3f}));
}

HeightField Slope() {
  HeightField field{kSize, kSize, 1, 1, {}};
  for (int i = 0; i < kSize * kSize; ++i) field.height_mm.push_back(0.01f * (i % kSize));
  return field;
}

std::vector<MapPicture> Pictures() {
  return MapPictures(Uniform(), Slope(), std::vector<float>(kSize * kSize, 0.7f));
}

TEST(ExportTest, EncodesEachMapAsItsNameSays) {
  const auto pictures = Pictures();
  ASSERT_EQ(pictures.size(), 11u);
  EXPECT_NEAR(Named(pictures, "normal_gl").image.samples[0], 0.8, 1e-6);
  EXPECT_NEAR(Named(pictures, "normal_gl").image.channel(1)[0], 0.9, 1e-6);
  EXPECT_NEAR(Named(pictures, "normal_gl").image.channel(2)[0], 0.5, 1e-6);
  EXPECT_NEAR(Named(pictures, "diffuse").image.samples[0], 0.5, 1e-5);
  EXPECT_NEAR(Named(pictures, "roughness").image.samples[0], 0.3, 1e-7);
  EXPECT_EQ(Named(pictures, "roughness").image.channels.size(), 1u);
  EXPECT_NEAR(Named(pictures, "metallic").image.samples[0], 0, 0.05);
  EXPECT_EQ(FileOf("wood", Named(pictures, "basecolor")), "wood_basecolor.png");
  EXPECT_EQ(FileOf("wood", Named(pictures, "specular")), "exact/wood_specular.png");
}

TEST(ExportTest, PacksOcclusionRoughnessAndMetalness) {
  const auto pictures = Pictures();
  const Image& orm = Named(pictures, "orm").image;
  EXPECT_NEAR(orm.channel(0)[0], 0.7, 1e-6);
  EXPECT_NEAR(orm.channel(1)[0], 0.3, 1e-6);
  EXPECT_EQ(orm.channel(2)[0], Named(pictures, "metallic").image.samples[0]);
}

TEST(ExportTest, HeightsAreBetweenItsLowestAndHighestPoint) {
  const HeightField field{2, 2, 1, 1, {-0.5f, 0.25f, 0.0f, 0.5f}};
  const auto range_mm = HeightRange(field);
  EXPECT_NEAR(range_mm[0], -0.5, 1e-6);
  EXPECT_NEAR(range_mm[1], 0.5, 1e-6);
  const MapPicture picture = HeightPicture(field, range_mm);
  for (size_t i = 0; i < 4; ++i) {
    const double h = range_mm[0] + picture.image.samples[i] * (range_mm[1] - range_mm[0]);
    EXPECT_NEAR(h, field.height_mm[i], 1e-6);
  }
  const HeightField flat{2, 2, 1, 1, {0, 0, 0, 0}};
  for (const float h : HeightPicture(flat, {0, 0}).image.samples) EXPECT_EQ(h, 0.0f);
}

TEST(ExportTest, DirectXMirrorsGreenOnly) {
  const auto pictures = Pictures();
  EXPECT_NEAR(Named(pictures, "normal_dx").image.samples[0], 0.8, 1e-6);
  EXPECT_NEAR(Named(pictures, "normal_dx").image.channel(1)[0], 0.1, 1e-6);
  EXPECT_EQ(Named(pictures, "normal_dx").encoding, "normal -Y");
}

// The pictures of the uniform material in a folder of their own.
struct Written {
  explicit Written(const std::string& bits) {
    const auto input = folder.path() / "input";
    std::ofstream(input) << "x";
    ExportOptions options;
    OptionSet set;
    AddExportOptions(&set, &options);
    options.bits = bits;
    Stage stage(folder.path() / "export", {"export", 1}, set, CommonOptions(), {input});
    files = WriteMapPictures(Uniform(), Pictures(), options, 2, &stage);
    stage.Commit({{"maps", files}}, {});
  }
  std::filesystem::path path(const std::string& file) const {
    return folder.path() / "export" / file;
  }
  Photo Read(const Json& entry) const { return ReadPhoto(path(entry["file"].get<std::string>())); }

  test::TemporaryFolder folder;
  Json files;
};

TEST(ExportTest, WritesBothDepthsWithinHalfAStep) {
  const Written written("both");
  EXPECT_EQ(written.files.size(), 21u);  // the height has 16 bits alone
  for (const Json& entry : written.files) {
    const Photo photo = written.Read(entry);
    EXPECT_EQ(photo.bits, entry["bits"].get<int>());
    if (entry["map"] == "height") {
      EXPECT_EQ(entry["range_mm"], Json({-0.5, 0.75}));
    }
    if (entry["map"] != "roughness") continue;
    EXPECT_NEAR(photo.image.at(0, 0), 0.3, 0.5 / (std::pow(2.0, photo.bits) - 1) + 1e-7);
  }
}

TEST(ExportTest, ExrFilesAreLinear) {
  const Written written("exr");
  EXPECT_EQ(written.files.size(), 22u);
  for (const Json& entry : written.files) {
    if (entry["map"] != "diffuse") continue;
    const Photo photo = written.Read(entry);
    const float stored = photo.image.at(0, 0);
    const float albedo = Uniform().maps.plane(kDiffuseR)[0];
    const bool exr = entry["bits"] == 32;
    EXPECT_EQ(entry["encoding"], exr ? "linear" : "sRGB");
    EXPECT_NEAR(exr ? stored : LinearFromSrgb(stored), albedo, exr ? 1e-5 : 0.01);
  }
}

// Chunks of the PNG specification: sRGB where the values are, pHYs in pixels per metre.
TEST(ExportTest, PicturesSayTheirTransferAndTheirScale) {
  const Written written("8");
  const std::string base = test::ReadAll(written.path("wood_basecolor.png"));
  const std::string rough = test::ReadAll(written.path("wood_roughness.png"));
  EXPECT_NE(base.find("sRGB"), std::string::npos);
  EXPECT_EQ(rough.find("sRGB"), std::string::npos);
  for (const std::string& png : {base, rough}) {
    const size_t at = png.find("pHYs");
    ASSERT_NE(at, std::string::npos);
    unsigned per_m = 0;
    for (size_t i = 4; i < 8; ++i) per_m = per_m << 8 | static_cast<unsigned char>(png[at + i]);
    EXPECT_NEAR(per_m, kSize / 0.12, 1);
    EXPECT_EQ(png[at + 12], 1);  // the unit is the metre
  }
}

}  // namespace
}  // namespace glint
