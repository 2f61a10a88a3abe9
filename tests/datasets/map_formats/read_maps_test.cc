#include "datasets/map_formats/read_maps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/errors/errors.h"
#include "base/formats/svbrdf_file.h"
#include "base/images/image.h"
#include "tests/support/data_folder.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr int kSide = 32;

// Fills tile `index` of a strip (or a whole image) with one colour.
void Fill(Image* image, int index, std::array<float, 3> color) {
  for (int c = 0; c < 3; ++c) {
    for (int row = 0; row < image->height; ++row) {
      for (int column = 0; column < image->height; ++column) {
        image->channel(
            c)[static_cast<size_t>(row) * image->width + index * image->height + column] =
            color[static_cast<size_t>(c)];
      }
    }
  }
}

// A normal of (0.36, 0.48, 0.8), encoded.
constexpr std::array<float, 3> kNormal = {0.68f, 0.74f, 0.9f};

void ExpectNormal(const SvbrdfMaps& maps) {
  EXPECT_NEAR(maps.at(kNormalX, 5, 7), 0.36, 0.006);
  EXPECT_NEAR(maps.at(kNormalY, 5, 7), 0.48, 0.006);
  EXPECT_NEAR(maps.at(kNormalZ, 5, 7), 0.80, 0.006);
}

TEST(ReadMaps, StripOfFour) {
  const test::TemporaryFolder folder;
  Image strip(4 * kSide, kSide, {"R", "G", "B"});
  Fill(&strip, 0, kNormal);
  Fill(&strip, 1, {0.5f, 0.6f, 0.7f});
  Fill(&strip, 2, {0.25f, 0.25f, 0.25f});
  Fill(&strip, 3, {0.1f, 0.2f, 0.3f});
  const fs::path file = folder.path() / "strip.png";
  WritePng(file, strip, 16);
  EXPECT_EQ(DetectMapLayout(file), MapLayout::kDirStrip);
  const SvbrdfMaps maps = ReadMaps(file);
  EXPECT_EQ(maps.width, kSide);
  EXPECT_EQ(maps.height, kSide);
  ExpectNormal(maps);
  EXPECT_NEAR(maps.at(kDiffuseG, 3, 30), std::pow(0.6, 2.2), 1e-4);
  EXPECT_NEAR(maps.at(kSpecularB, 3, 30), 0.3, 1e-4);
  EXPECT_NEAR(maps.at(kRoughness, 31, 0), 0.25, 1e-4);
  MapEncodings encodings;
  encodings.diffuse = Encoding::kLinear;
  encodings.specular = Encoding::kGamma22;
  EXPECT_NEAR(ReadMaps(file, encodings).at(kDiffuseG, 3, 30), 0.6, 1e-4);
  EXPECT_NEAR(ReadMaps(file, encodings).at(kSpecularB, 3, 30), std::pow(0.3, 2.2), 1e-4);
}

TEST(ReadMaps, StripOfAPhotoAndFour) {
  const test::TemporaryFolder folder;
  Image strip(5 * kSide, kSide, {"R", "G", "B"});
  Fill(&strip, 0, {0.9f, 0.9f, 0.9f});
  Fill(&strip, 1, kNormal);
  Fill(&strip, 2, {0.5f, 0.6f, 0.7f});
  Fill(&strip, 3, {0.25f, 0.25f, 0.25f});
  Fill(&strip, 4, {0.1f, 0.2f, 0.3f});
  const fs::path file = folder.path() / "strip.png";
  WritePng(file, strip, 16);
  EXPECT_EQ(DetectMapLayout(file), MapLayout::kPhotoStrip);
  const SvbrdfMaps maps = ReadMaps(file);
  ExpectNormal(maps);
  EXPECT_NEAR(maps.at(kDiffuseR, 3, 30), 0.5, 1e-4);
  EXPECT_NEAR(maps.at(kSpecularR, 3, 30), 0.1, 1e-4);
  EXPECT_NEAR(maps.at(kRoughness, 31, 0), 0.25, 1e-4);
}

class MapFolder : public testing::Test {
 protected:
  void Write(const std::string& kind, std::array<float, 3> color, int side = kSide) {
    Image image(side, side, {"R", "G", "B"});
    Fill(&image, 0, color);
    WritePng(folder_.path() / ("Wood_01_" + kind + ".png"), image, 16);
  }
  void WriteThree() {
    Write("Color", {0.5f, 0.8f, 0.2f});
    Write("NormalGL", kNormal);
    Write("Roughness", {0.0f, 0.0f, 0.0f});
  }
  std::string Message() {
    return test::MessageOf<UserError>([&] { ReadMaps(folder_.path()); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(MapFolder, WithoutMetalnessIsADielectric) {
  WriteThree();
  EXPECT_EQ(DetectMapLayout(folder_.path()), MapLayout::kColorFolder);
  const SvbrdfMaps maps = ReadMaps(folder_.path());
  ExpectNormal(maps);
  EXPECT_NEAR(maps.at(kDiffuseR, 0, 0), 0.214041, 1e-4);  // sRGB 0.5
  EXPECT_NEAR(maps.at(kSpecularG, 0, 0), 0.04, 1e-6);
  EXPECT_GT(maps.at(kRoughness, 0, 0), 0);  // a stored 0 would be a mirror
}

TEST_F(MapFolder, MetalnessMovesColourFromDiffuseToSpecular) {
  WriteThree();
  Write("Metalness", {0.75f, 0.75f, 0.75f});
  const SvbrdfMaps maps = ReadMaps(folder_.path());
  EXPECT_NEAR(maps.at(kDiffuseR, 0, 0), 0.25 * 0.214041, 1e-4);
  EXPECT_NEAR(maps.at(kSpecularR, 0, 0), 0.25 * 0.04 + 0.75 * 0.214041, 1e-4);
}

TEST_F(MapFolder, WhatIsWrongIsNamed) {
  Write("Color", {0.5f, 0.8f, 0.2f});
  EXPECT_THAT(Message(), AllOf(HasSubstr("NormalGL"), HasSubstr("no file")));
  Write("NormalGL", kNormal);
  EXPECT_THAT(Message(), AllOf(HasSubstr("Roughness"), HasSubstr("no file")));
  Write("Roughness", {0.5f, 0.5f, 0.5f}, 2 * kSide);
  EXPECT_THAT(Message(),
              AllOf(HasSubstr("Wood_01_Roughness.png"), HasSubstr("64x64"), HasSubstr("32x32")));
  test::WriteAll(folder_.path() / "Wood_01_Roughness.png", "not an image");
  EXPECT_THAT(Message(), AllOf(HasSubstr("Wood_01_Roughness.png"), HasSubstr("no image")));
  test::WriteAll(folder_.path() / "Stone_Color.jpg", "x");
  EXPECT_THAT(Message(), HasSubstr("two files named *_Color"));
}

TEST(ReadMaps, SvbrdfExrByFileAndByFolder) {
  const test::TemporaryFolder folder;
  SvbrdfMaps maps(kSide, kSide);
  for (float& z : maps.plane(kNormalZ)) z = 1;
  for (float& r : maps.plane(kRoughness)) r = 0.4f;
  maps.at(kDiffuseG, 3, 4) = 0.7f;
  const fs::path file = folder.path() / "svbrdf.exr";
  WriteSvbrdf(file, maps, ReflectanceConvention::Photograph());
  EXPECT_EQ(ReadMaps(file).planes, maps.planes);
  EXPECT_EQ(ReadMaps(folder.path()).planes, maps.planes);
}

TEST(ReadMaps, WhatIsNoMaterialIsRejected) {
  const test::TemporaryFolder folder;
  const auto message = [&](const fs::path& path) {
    return test::MessageOf<UserError>([&] { ReadMaps(path); });
  };
  EXPECT_THAT(message(folder.path() / "absent"), HasSubstr("no such file"));
  EXPECT_THAT(message(folder.path()), HasSubstr("without any known maps"));
  WritePng(folder.path() / "square.png", Image(64, 64, {"R", "G", "B"}), 8);
  EXPECT_THAT(message(folder.path() / "square.png"), AllOf(HasSubstr("64x64"), HasSubstr("strip")));
  test::WriteAll(folder.path() / "text.png", "hello");
  EXPECT_THAT(message(folder.path() / "text.png"), HasSubstr("no image"));
  WritePng(folder.path() / "tiny.png", Image(4, 1, {"R", "G", "B"}), 8);
  EXPECT_THAT(message(folder.path() / "tiny.png"), HasSubstr("4x1"));
  Image nan(4 * kSide, kSide, {"R", "G", "B"});
  nan.samples[77] = std::nanf("");
  WriteExr(folder.path() / "nan.exr", nan);
  EXPECT_THAT(message(folder.path() / "nan.exr"), HasSubstr("not a number"));
}

// All normals of real materials point up, on the whole, and every value is in its range.
TEST(ReadMaps, RealMaterialsAreInRange) {
  const fs::path materials = test::DataFolder() / "materials" / "validation";
  if (!fs::exists(materials)) GTEST_SKIP() << "no real data here";
  int read = 0;
  for (const auto& entry : fs::directory_iterator(materials)) {
    if (!entry.is_directory() || ++read > 4) continue;
    const SvbrdfMaps maps = ReadMaps(entry.path());
    ASSERT_EQ(maps.width, 512) << entry.path();
    double mean_z = 0;
    for (size_t i = 0; i < maps.texels(); ++i) {
      mean_z += maps.plane(kNormalZ)[i];
      ASSERT_GT(maps.plane(kNormalZ)[i], 0);
      ASSERT_LE(maps.plane(kDiffuseG)[i], 1);
      ASSERT_GE(maps.plane(kSpecularG)[i], 0);
    }
    EXPECT_GT(mean_z / static_cast<double>(maps.texels()), 0.8) << entry.path();
  }
  EXPECT_GE(read, 4);
}

}  // namespace
}  // namespace glint
