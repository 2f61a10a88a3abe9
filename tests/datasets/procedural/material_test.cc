#include "datasets/procedural/material.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <thread>

#include "tests/datasets/procedural/measures.h"

namespace glint {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// The first thing that is out of range, or nothing.
std::string Fault(const SvbrdfMaps& maps) {
  for (size_t i = 0; i < maps.texels(); ++i) {
    const auto value = [&](int p) { return maps.plane(p)[i]; };
    const double x = value(kNormalX), y = value(kNormalY), z = value(kNormalZ);
    if (!(std::fabs(x * x + y * y + z * z - 1.0) < 1e-5)) return "normal is not unit";
    if (!(z > std::cos(77.0 * M_PI / 180.0))) return "normal is too steep";
    for (int c = 0; c < 3; ++c) {
      const float diffuse = value(kDiffuseR + c), specular = value(kSpecularR + c);
      if (!(diffuse >= 0.0f && diffuse <= 1.0f)) return "diffuse is out of [0, 1]";
      if (!(specular >= 0.0f && specular <= 1.0f)) return "specular is out of [0, 1]";
      if (!(diffuse + specular <= 1.0f + 1e-5f)) return "diffuse + specular exceeds 1";
    }
    if (!(value(kRoughness) >= 0.05f && value(kRoughness) <= 1.0f))
      return "roughness is out of range";
  }
  return "";
}

TEST(MaterialTest, SameSeedGivesSameBytesFromAnyThread) {
  constexpr int kSeeds = 12;
  std::vector<SvbrdfMaps> here(kSeeds), there(kSeeds);
  for (int i = 0; i < kSeeds; ++i) here[i] = MakeMaterial(static_cast<uint64_t>(i), 64, 64);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {  // interleaved and backwards
      for (int i = kSeeds - 1 - t; i >= 0; i -= 4)
        there[i] = MakeMaterial(static_cast<uint64_t>(i), 64, 64);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < kSeeds; ++i) EXPECT_EQ(here[i].planes, there[i].planes) << "seed " << i;
}

TEST(MaterialTest, OffersManyFamiliesWithUniqueNames) {
  std::vector<std::string> names = MaterialFamilies();
  EXPECT_GE(names.size(), 40u);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

TEST(MaterialTest, EveryFamilyKeepsEveryPlaneInRange) {
  for (const std::string& family : MaterialFamilies()) {
    for (uint64_t seed = 0; seed < 8; ++seed) {
      EXPECT_EQ(Fault(MakeMaterial(family, seed, 61, 47)), "") << family << " seed " << seed;
    }
  }
}

TEST(MaterialTest, BlendsKeepEveryPlaneInRange) {
  int blends = 0;
  for (uint64_t seed = 0; seed < 150; ++seed) {
    if (DrawRecipe(seed).second.empty()) continue;
    ++blends;
    EXPECT_EQ(Fault(MakeMaterial(seed, 48, 48)), "") << "seed " << seed;
  }
  EXPECT_GE(blends, 20);
}

TEST(MaterialTest, FamiliesAndSeedsDiffer) {
  std::vector<SvbrdfMaps> seen;
  for (const std::string& family : MaterialFamilies()) {
    for (uint64_t seed = 3; seed < 5; ++seed) {
      seen.push_back(MakeMaterial(family, seed, 64, 64));
      for (size_t other = 0; other + 1 < seen.size(); ++other) {
        EXPECT_GT(MeanDifference(seen.back(), seen[other]), 1e-3) << family << " seed " << seed;
      }
    }
  }
}

TEST(MaterialTest, EveryFamilyVariesOverThePicture) {
  for (const std::string& family : MaterialFamilies()) {
    double relief = 0.0, color = 0.0, roughness = 0.0;
    for (uint64_t seed = 0; seed < 8; ++seed) {
      const SvbrdfMaps maps = MakeMaterial(family, seed, 64, 64);
      relief = std::max({relief, Spread(maps.plane(kNormalX)), Spread(maps.plane(kNormalY))});
      for (int c = kDiffuseR; c <= kSpecularB; ++c) color = std::max(color, Spread(maps.plane(c)));
      roughness = std::max(roughness, Spread(maps.plane(kRoughness)));
    }
    EXPECT_GT(relief, 0.005) << family;
    EXPECT_GT(color, 0.01) << family;
    EXPECT_GT(roughness, 0.01) << family;
  }
}

TEST(MaterialTest, ResolutionChangesSamplingAndNotTheMaterial) {
  for (const std::string& family : MaterialFamilies()) {
    double same = 0.0, other = 0.0;
    for (uint64_t seed = 20; seed < 24; ++seed) {
      const SvbrdfMaps coarse = MakeMaterial(family, seed, 128, 128);
      same += MeanDifference(Halved(MakeMaterial(family, seed, 256, 256)), coarse);
      other += MeanDifference(MakeMaterial(family, seed + 100, 128, 128), coarse);
    }
    EXPECT_LT(same / 4.0, 0.025) << family;
    EXPECT_LT(same, 0.35 * other) << family;
  }
}

TEST(MaterialTest, ARectangleIsTheMiddleOfTheSquare) {
  const SvbrdfMaps square = MakeMaterial("stamps", 5, 64, 64);
  const SvbrdfMaps strip = MakeMaterial("stamps", 5, 64, 32);
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    for (int row = 0; row < 32; ++row) {
      for (int column = 0; column < 64; ++column) {
        ASSERT_NEAR(strip.at(p, row, column), square.at(p, row + 16, column), 2e-3)
            << "plane " << p << " row " << row << " column " << column;
      }
    }
  }
}

TEST(MaterialTest, MetalsHaveDarkDiffuse) {
  size_t metal_texels = 0;
  for (const std::string& family : MaterialFamilies()) {
    for (uint64_t seed = 0; seed < 12; ++seed) {
      const SvbrdfMaps maps = MakeMaterial(family, seed, 32, 32);
      for (size_t i = 0; i < maps.texels(); ++i) {
        for (int c = 0; c < 3; ++c) {
          // A specular of more than .08 comes from metal alone; its share bounds the diffuse part.
          const float metal = (maps.plane(kSpecularR + c)[i] - 0.08f) / 0.92f;
          const float diffuse = maps.plane(kDiffuseR + c)[i];
          ASSERT_LE(diffuse, 1.0f - std::max(metal, 0.0f) * 0.92f) << family << " seed " << seed;
          metal_texels += metal > 0.5f ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(metal_texels, 10000u);  // the families do hold metals
  int bare = 0, dark = 0;
  for (uint64_t seed = 0; seed < 80; ++seed) {
    const SvbrdfMaps maps = MakeMaterial("smooth", seed, 16, 16);
    const auto specular = maps.plane(kSpecularG), diffuse = maps.plane(kDiffuseG);
    if (*std::min_element(specular.begin(), specular.end()) < 0.4f) continue;
    ++bare;
    dark += *std::max_element(diffuse.begin(), diffuse.end()) < 0.07f ? 1 : 0;
  }
  EXPECT_GE(bare, 8);
  EXPECT_GE(dark, bare * 3 / 4);  // the others are dusty
}

TEST(MaterialTest, ReliefReachesSteepSlopesButIsMostlyGentle) {
  size_t gentle = 0, steep = 0, all = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const SvbrdfMaps maps = MakeMaterial(seed, 128, 128);
    for (const float z : maps.plane(kNormalZ)) {
      ++all;
      gentle += z > std::cos(20.0 * M_PI / 180.0) ? 1 : 0;
      steep += z < std::cos(60.0 * M_PI / 180.0) ? 1 : 0;
    }
  }
  EXPECT_GT(gentle, all * 6 / 10);
  EXPECT_GT(steep, all / 2000);
  EXPECT_LT(steep, all / 20);
}

TEST(MaterialTest, SeedsCoverAllFamiliesAndTheWholeRangeOfReflectance) {
  std::map<std::string, int> families;
  for (uint64_t seed = 0; seed < 4000; ++seed) ++families[DrawRecipe(seed).family];
  EXPECT_EQ(families.size(), MaterialFamilies().size());
  for (const auto& [name, count] : families) EXPECT_GT(count, 20) << name;
  int dark = 0, light = 0, glossy = 0, rough = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const SvbrdfMaps maps = MakeMaterial(seed, 8, 8);
    dark += maps.plane(kDiffuseG)[27] < 0.03f ? 1 : 0;
    light += maps.plane(kDiffuseG)[27] > 0.5f ? 1 : 0;
    glossy += maps.plane(kRoughness)[27] < 0.25f ? 1 : 0;
    rough += maps.plane(kRoughness)[27] > 0.75f ? 1 : 0;
  }
  for (const int count : {dark, light, glossy, rough}) EXPECT_GT(count, 10);
}

// Training varnishes them more often than others, so another mark changes its materials.
TEST(MaterialTest, WoodAndPaintAreMarked) {
  std::vector<std::string> marked;
  for (const std::string& family : MaterialFamilies()) {
    if (IsWoodOrPaint(family)) marked.push_back(family);
  }
  EXPECT_THAT(marked,
              ElementsAre("wood", "planks", "stripes", "peeling_paint", "chipboard", "impasto"));
  EXPECT_THROW(IsWoodOrPaint("granit"), std::invalid_argument);
}

TEST(MaterialTest, RecipeNamesWhatTheSeedMakes) {
  for (uint64_t seed = kReservedSeedBase; seed < kReservedSeedBase + 10; ++seed) {
    const MaterialRecipe recipe = DrawRecipe(seed);
    EXPECT_EQ(recipe.seed, seed);
    EXPECT_EQ(MakeMaterial(recipe, 16, 16).planes, MakeMaterial(seed, 16, 16).planes);
  }
}

TEST(MaterialTest, WrongRequestsSayWhatIsAllowed) {
  EXPECT_THROW(MakeMaterial(1, 0, 8), std::invalid_argument);
  EXPECT_THROW(MakeMaterial(1, 8, 1 << 20), std::invalid_argument);
  try {
    MakeMaterial("granit", 1, 8, 8);
    FAIL() << "an unknown family was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("granit"));
    EXPECT_THAT(error.what(), HasSubstr("marble"));
  }
}

TEST(MaterialTest, ASingleTexelIsAMaterialToo) {
  for (const std::string& family : MaterialFamilies()) {
    EXPECT_EQ(Fault(MakeMaterial(family, 2, 1, 1)), "") << family;
  }
}

}  // namespace
}  // namespace glint
