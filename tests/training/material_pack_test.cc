#include "datasets/material_pack/material_pack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/support/process.h"
#include "tests/training/toy_materials.h"
#include "training/training_materials.h"

namespace glint {
namespace {

double Mean(const SvbrdfMaps& maps, int plane) {
  double sum = 0;
  for (const float x : maps.plane(plane)) sum += x;
  return sum / static_cast<double>(maps.texels());
}

TEST(MaterialPack, GivesBackWhatWasPackedWithinItsSteps) {
  const test::TemporaryFolder folder;
  const SvbrdfMaps maps = ToyMaterial(3, 24, 24);
  WriteMaterialPack(folder.path() / "pack.safetensors", {PackMaterial("toy", maps)});
  const MaterialPack pack = ReadMaterialPack(folder.path() / "pack.safetensors");
  ASSERT_EQ(pack.size(), 1u);
  EXPECT_EQ(pack[0].name, "toy");
  const SvbrdfMaps back = CutMaterial(pack[0], 0, 0, 24, 24);
  for (size_t i = 0; i < maps.planes.size(); ++i) {
    EXPECT_NEAR(back.planes[i], maps.planes[i], 3e-4) << i;
  }
}

TEST(MaterialPack, ASmallerCutKeepsTheWindowsMeans) {
  const PackedMaterial packed = PackMaterial("toy", ToyMaterial(4, 40, 40));
  const SvbrdfMaps window = CutMaterial(packed, 3, 5, 33, 33);
  const SvbrdfMaps cut = CutMaterial(packed, 3, 5, 33, 16);
  for (const int plane : {kDiffuseR, kDiffuseB, kSpecularG, kRoughness}) {
    EXPECT_NEAR(Mean(cut, plane), Mean(window, plane), 1e-5) << plane;
  }
  for (size_t i = 0; i < cut.texels(); ++i) {
    const float x = cut.plane(kNormalX)[i], y = cut.plane(kNormalY)[i], z = cut.plane(kNormalZ)[i];
    EXPECT_NEAR(x * x + y * y + z * z, 1.0f, 1e-5f);
  }
}

TEST(MaterialPack, WhatIsNoPackOrNoSquareIsRefused) {
  const test::TemporaryFolder folder;
  test::WriteAll(folder.path() / "text.safetensors", "not a pack at all, only some text");
  EXPECT_THROW(ReadMaterialPack(folder.path() / "text.safetensors"), std::runtime_error);
  EXPECT_THROW(PackMaterial("oblong", SvbrdfMaps(8, 4)), std::invalid_argument);
  const PackedMaterial packed = PackMaterial("toy", ToyMaterial(4, 40, 40));
  EXPECT_THROW(CutMaterial(packed, 20, 0, 30, 8), std::invalid_argument);
}

TEST(TrainingMaterials, DependOnTheirNumberAloneAndTakeTheirShareOfThePack) {
  SvbrdfMaps marked(32, 32);
  std::fill(marked.planes.begin(), marked.planes.end(), 0.04f);
  std::fill(marked.plane(kNormalX).begin(), marked.plane(kNormalX).end(), 0.0f);
  std::fill(marked.plane(kNormalY).begin(), marked.plane(kNormalY).end(), 0.0f);
  std::fill(marked.plane(kNormalZ).begin(), marked.plane(kNormalZ).end(), 1.0f);
  std::fill(marked.plane(kDiffuseR).begin(), marked.plane(kDiffuseR).end(), 0.625f);
  const MaterialPack pack{PackMaterial("marked", marked)};
  TrainingMaterialOptions options{7, 16, 0.5, 0.0};
  int packed = 0;
  for (std::uint64_t k = 0; k < 40; ++k) {
    const SvbrdfMaps maps = TrainingMaterial(options, &pack, k);
    EXPECT_EQ(maps.planes, TrainingMaterial(options, &pack, k).planes);
    const bool from_pack = std::abs(maps.at(kDiffuseR, 5, 5) - 0.625f) < 1e-3f;
    packed += from_pack;
    if (from_pack) {
      EXPECT_GE(maps.at(kSpecularG, 5, 5), 0.019f);
      EXPECT_LE(maps.at(kSpecularG, 5, 5), 0.23f);
    }
  }
  EXPECT_GT(packed, 10);
  EXPECT_LT(packed, 30);
  options.pack_share = 0;
  EXPECT_EQ(TrainingMaterial(options, &pack, 3).planes,
            TrainingMaterial(options, nullptr, 3).planes);
}

TEST(TrainingMaterials, GlazedOnesAreDarkDielectricsAndMostlyGlossy) {
  const auto mean = [](const SvbrdfMaps& maps, int plane) {
    double sum = 0;
    for (const float value : maps.plane(plane)) sum += value;
    return sum / static_cast<double>(maps.texels());
  };
  TrainingMaterialOptions options{7, 32, 0.0, 0.0};
  int changed = 0, smoother = 0;
  double brighter = 0;
  for (std::uint64_t k = 0; k < 30; ++k) {
    options.glossy_dielectric_share = 0;
    const SvbrdfMaps plain = TrainingMaterial(options, nullptr, k);
    options.glossy_dielectric_share = 1;
    const SvbrdfMaps glossy = TrainingMaterial(options, nullptr, k);
    changed += glossy.planes != plain.planes;
    brighter = std::max(brighter, mean(glossy, kDiffuseG) - mean(plain, kDiffuseG));
    smoother += mean(glossy, kRoughness) < 0.9 * mean(plain, kRoughness);
    EXPECT_LE(mean(glossy, kRoughness), 1.5 * mean(plain, kRoughness) + 1e-4);
    EXPECT_LE(mean(glossy, kSpecularG), std::max(0.23, mean(plain, kSpecularG)));
    for (size_t i = 0; i < glossy.texels(); ++i) {
      const float x = glossy.plane(kNormalX)[i], y = glossy.plane(kNormalY)[i],
                  z = glossy.plane(kNormalZ)[i];
      ASSERT_NEAR(x * x + y * y + z * z, 1, 1e-4);
      ASSERT_GE(glossy.plane(kRoughness)[i], 0.0499f);
    }
  }
  EXPECT_GT(changed, 25);
  EXPECT_LT(brighter, 1e-3);
  EXPECT_GT(smoother, 12);  // two thirds, of which some in small places only
}

}  // namespace
}  // namespace glint
