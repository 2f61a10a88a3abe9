#include "training/training_materials.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "datasets/material_pack/pnm_materials.h"
#include "tests/support/process.h"

namespace glint {
namespace {

TEST(TrainingMaterials, HaveMetalAsOftenAsAskedFor) {
  TrainingMaterialOptions options;
  options.size = 32;
  options.metal_share = 0.1;
  options.glossy_dielectric_share = 0.2;
  int metal = 0;
  constexpr int kMaterials = 600;
  for (std::uint64_t k = 0; k < kMaterials; ++k) {
    metal += HasMetal(TrainingMaterial(options, nullptr, k));
  }
  EXPECT_NEAR(static_cast<double>(metal) / kMaterials, 0.1, 0.035);  // three standard deviations
}

TEST(TrainingMaterials, WithVarnishAreMoreOftenSmoothDielectrics) {
  TrainingMaterialOptions options;
  options.size = 32;
  options.metal_share = 0;
  const auto smooth = [&](double share) {
    options.varnish_share = share;
    int count = 0;
    for (std::uint64_t k = 0; k < 200; ++k) {
      const SvbrdfMaps maps = TrainingMaterial(options, nullptr, k);
      const auto [low, high] = std::ranges::minmax(maps.plane(kSpecularG));
      const auto roughness = std::ranges::max(maps.plane(kRoughness));
      count += high - low < 1e-4f && roughness < 0.45f;
    }
    return count;
  };
  EXPECT_GT(smooth(1), smooth(0) + 40);  // a fifth of all, and most of wood and paint
}

// The two ways to a pack agree where one has to do without libraries that read pictures.
TEST(PnmMaterials, AreReadByTheNamesOfTheirMaps) {
  const test::TemporaryFolder folder;
  const auto write = [&](const std::string& name, bool colour, const std::string& texel) {
    std::string values;
    for (int i = 0; i < 16; ++i) values += texel;
    folder.Write("Wood/Wood_" + name,
                 std::string(colour ? "P6" : "P5") + "\n# a comment\n4 4\n255\n" + values);
  };
  write("Color.ppm", true, std::string("\xff\xbc\x00", 3));
  write("NormalGL.ppm", true, std::string("\x80\x80\xff", 3));
  write("Roughness.pgm", false, "\x80");
  const PackedMaterial packed = ReadPnmMaterial(folder.path() / "Wood", 2);
  EXPECT_EQ(packed.name, "Wood");
  EXPECT_EQ(packed.size, 2);
  const SvbrdfMaps maps = CutMaterial(packed, 0, 0, 2, 2);
  EXPECT_NEAR(maps.plane(kDiffuseR)[0], 1, 1e-3);
  EXPECT_NEAR(maps.plane(kDiffuseG)[0], 0.5029, 1e-3);
  EXPECT_NEAR(maps.plane(kDiffuseB)[0], 0, 1e-3);
  EXPECT_NEAR(maps.plane(kSpecularR)[0], 0.04, 1e-3);
  EXPECT_NEAR(maps.plane(kRoughness)[0], 0.502, 1e-3);
  EXPECT_NEAR(maps.plane(kNormalZ)[0], 1, 1e-3);
}

TEST(PnmMaterials, SayWhichMapIsMissing) {
  const test::TemporaryFolder folder;
  try {
    ReadPnmMaterial(folder.path(), 2);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("Color: found no file named *_Color"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace glint
