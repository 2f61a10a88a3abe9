#include "pipeline/export/metal_roughness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/pipeline/export/exported_material.h"

namespace glint {
namespace {

using test::UniformMaps;

double MetalRoughnessError(const MetalRoughness& converted, const SvbrdfMaps& maps,
                           const ReflectanceConvention& convention) {
  return ShadingErrors(maps, convention, {MetalRoughnessShading(converted, maps)}, 1)[0];
}

// Two foils on card: a rough dielectric and a coloured metal, each with noise.
SvbrdfMaps Foils(int size) {
  std::mt19937 random(4);
  std::normal_distribution<float> normal(0, 1);
  SvbrdfMaps maps(size, size);
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const size_t i = static_cast<size_t>(row) * size + column;
      const bool metal = column >= size / 2;
      const float card[kSvbrdfPlanes] = {0, 0, 1, 0.5f, 0.3f, 0.2f, 0.04f, 0.04f, 0.04f, 0.5f};
      const float gold[kSvbrdfPlanes] = {0, 0, 1, 0.02f, 0.02f, 0.02f, 0.9f, 0.7f, 0.3f, 0.3f};
      for (int p = 0; p < kSvbrdfPlanes; ++p) {
        const float value = metal ? gold[p] : card[p];
        const float noise = p > kNormalZ ? 0.15f * value * normal(random) : 0.0f;
        maps.plane(p)[i] = std::clamp(value + noise, p > kNormalZ ? 0.01f : -1.0f, 1.0f);
      }
    }
  }
  return maps;
}

// What a metal-roughness material can be comes back: dielectrics and metals.
TEST(MetalRoughnessTest, RecoversWhatItCanBe) {
  const auto plastic =
      ToMetalRoughness(UniformMaps({0, 0, 1, 0.8f, 0.5f, 0.2f, 0.04f, 0.04f, 0.04f, 0.4f}),
                       {DiffuseWeight::kOneMinusSpecular}, {}, 1);
  EXPECT_NEAR(plastic.metallic[5], 0, 0.01);
  EXPECT_NEAR(plastic.ColorAt(5)[0], 0.8, 0.03);
  EXPECT_NEAR(plastic.ColorAt(5)[2], 0.2, 0.02);
  const auto gold = ToMetalRoughness(UniformMaps({0, 0, 1, 0, 0, 0, 0.9f, 0.7f, 0.3f, 0.3f}),
                                     {DiffuseWeight::kOne}, {}, 1);
  EXPECT_NEAR(gold.metallic[5], 1, 0.02);
  EXPECT_NEAR(gold.ColorAt(5)[0], 0.9, 0.03);
  EXPECT_NEAR(gold.ColorAt(5)[2], 0.3, 0.03);
}

// All there is beside its highlight: without it the metal would be black there.
TEST(MetalRoughnessTest, AMetalKeepsItsLittleDiffuseLight) {
  for (const float diffuse : {0.007f, 0.1f}) {
    const SvbrdfMaps maps =
        UniformMaps({0, 0, 1, diffuse, diffuse, diffuse, 0.45f, 0.45f, 0.45f, 0.25f});
    const auto found = ToMetalRoughness(maps, {DiffuseWeight::kOneMinusSpecular}, {}, 1);
    EXPECT_LT(found.metallic[5], 1.0f);
    EXPECT_LT(MetalRoughnessError(found, maps, {DiffuseWeight::kOneMinusSpecular}), 0.05);
  }
}

// Nothing of metal reflects so little, however well a dark metal would look like it.
TEST(MetalRoughnessTest, DarkDielectricsAreNoMetals) {
  const std::array<float, 10> felt = {0, 0, 1, 0.01f, 0.01f, 0.01f, 0.065f, 0.065f, 0.065f, 0.87f};
  const std::array<float, 10> wood = {0, 0, 1, 0.03f, 0.012f, 0.004f, 0.07f, 0.055f, 0.04f, 0.3f};
  const std::array<float, 10> leather = {0,     0,      1,      0.006f, 0.01f,
                                         0.03f, 0.003f, 0.003f, 0.006f, 0.4f};
  for (const auto& texel : {felt, wood, leather}) {
    const auto found =
        ToMetalRoughness(UniformMaps(texel), {DiffuseWeight::kOneMinusSpecular}, {}, 1);
    EXPECT_LT(found.metallic[5], 0.05f) << texel[6];
  }
}

// Foil under a light that is stronger than thought: only its colour and that it is black beside its
// highlight tell.
TEST(MetalRoughnessTest, ColouredFoilIsMetal) {
  const auto found =
      ToMetalRoughness(UniformMaps({0, 0, 1, 0.004f, 0.004f, 0.004f, 0.21f, 0.19f, 0.08f, 0.1f}),
                       {DiffuseWeight::kOneMinusSpecular}, {}, 1);
  EXPECT_GT(found.metallic[5], 0.7f);
}

TEST(MetalRoughnessTest, BetweenTheKindsTheShareOfMetalsDecides) {
  const SvbrdfMaps maps = UniformMaps({0, 0, 1, 0.01f, 0.01f, 0.01f, 0.11f, 0.11f, 0.11f, 0.5f});
  MetalRoughnessOptions possible;
  possible.metal_share = 0.9;
  MetalRoughnessOptions rare;
  rare.metal_share = 0.01;
  const auto metallic = [&](const MetalRoughnessOptions& options) {
    return ToMetalRoughness(maps, {DiffuseWeight::kOne}, options, 1).metallic[5];
  };
  EXPECT_GT(metallic(possible), metallic(rare) + 0.3f);
}

TEST(MetalRoughnessTest, MetalnessIsOfSubstancesNotOfTexels) {
  const SvbrdfMaps maps = Foils(48);
  const auto found = ToMetalRoughness(maps, {DiffuseWeight::kOne}, {}, 2);
  int wrong = 0;
  for (int row = 0; row < 48; ++row) {
    for (int column = 0; column < 48; ++column) {
      const float truth = column >= 24 ? 1.0f : 0.0f;
      wrong += std::abs(found.metallic[static_cast<size_t>(row) * 48 + column] - truth) > 0.3f;
    }
  }
  EXPECT_LT(wrong, 12);  // half a per cent
  MetalRoughnessOptions alone;
  alone.radius = 0;
  alone.blend_cost = 0;
  // Sharing costs little of what single texels could be.
  EXPECT_LT(MetalRoughnessError(found, maps, {DiffuseWeight::kOne}),
            1.2 * MetalRoughnessError(ToMetalRoughness(maps, {DiffuseWeight::kOne}, alone, 1), maps,
                                      {DiffuseWeight::kOne}));
}

// No base colour nearby explains it better.
TEST(MetalRoughnessTest, IsTheBestOfItsNeighbourhood) {
  const SvbrdfMaps maps = UniformMaps({0, 0, 1, 0.3f, 0.2f, 0.1f, 0.12f, 0.1f, 0.08f, 0.35f});
  MetalRoughnessOptions options;
  options.blend_cost = 0;
  const MetalRoughness found = ToMetalRoughness(maps, {DiffuseWeight::kOne}, options, 1);
  const double error = MetalRoughnessError(found, maps, {DiffuseWeight::kOne});
  for (const float factor : {0.8f, 1.25f}) {
    MetalRoughness other = found;
    for (float& base : other.base_color) base = std::min(1.0f, base * factor);
    EXPECT_GT(MetalRoughnessError(other, maps, {DiffuseWeight::kOne}), error);
    other = found;
    for (float& metallic : other.metallic) metallic = std::min(1.0f, metallic * factor * factor);
    EXPECT_GT(MetalRoughnessError(other, maps, {DiffuseWeight::kOne}), 0.98 * error);
  }
}

// Wider than what is averaged at a time, and neighbours beyond the borders.
TEST(MetalRoughnessTest, MirroredMapsAreConvertedAlike) {
  constexpr int kFoilsWidth = 300, kFoilsHeight = 5;
  const SvbrdfMaps foils = Foils(kFoilsWidth);
  SvbrdfMaps maps(kFoilsWidth, kFoilsHeight), mirrored(kFoilsWidth, kFoilsHeight);
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    for (int row = 0; row < kFoilsHeight; ++row) {
      for (int column = 0; column < kFoilsWidth; ++column) {
        maps.at(p, row, column) = foils.at(p, row, column);
        mirrored.at(p, row, kFoilsWidth - 1 - column) = foils.at(p, row, column);
      }
    }
  }
  MetalRoughnessOptions options;
  options.radius = 64;
  const auto found = ToMetalRoughness(maps, {DiffuseWeight::kOne}, options, 1);
  const auto of_mirrored = ToMetalRoughness(mirrored, {DiffuseWeight::kOne}, options, 1);
  for (int row = 0; row < kFoilsHeight; ++row) {
    for (int column = 0; column < kFoilsWidth; ++column) {
      const size_t i = static_cast<size_t>(row) * kFoilsWidth + static_cast<size_t>(column);
      const size_t j = static_cast<size_t>(row + 1) * kFoilsWidth - 1 - static_cast<size_t>(column);
      EXPECT_NEAR(found.metallic[i], of_mirrored.metallic[j], 1e-3) << column;
      EXPECT_NEAR(found.ColorAt(i)[1], of_mirrored.ColorAt(j)[1], 1e-3) << column;
    }
  }
}

TEST(MetalRoughnessTest, DoesNotDependOnTheNumberOfThreads) {
  const SvbrdfMaps maps = Foils(24);
  const auto one = ToMetalRoughness(maps, {DiffuseWeight::kOne}, {}, 1);
  const auto three = ToMetalRoughness(maps, {DiffuseWeight::kOne}, {}, 3);
  EXPECT_EQ(one.base_color, three.base_color);
  EXPECT_EQ(one.metallic, three.metallic);
}

TEST(MetalRoughnessTest, RowsAreThoseOfTheWhole) {
  const SvbrdfMaps maps = Foils(24);
  const auto whole = ToMetalRoughness(maps, {DiffuseWeight::kOne}, {}, 1);
  const MetalRoughnessOptions options;
  MetalConverter converter({DiffuseWeight::kOne}, options, 2);
  for (int first = 0; first < 24; first += 5) {
    const int rows = std::min(5, 24 - first);
    const int above = std::min(first, options.radius);
    const int below = std::min(24 - first - rows, options.radius);
    SvbrdfMaps part(24, above + rows + below);
    for (int p = 0; p < kSvbrdfPlanes; ++p) {
      std::copy_n(maps.plane(p).begin() + 24 * (first - above), part.texels(),
                  part.plane(p).begin());
    }
    const MetalRoughness found = converter.Convert(part, above, below);
    for (size_t i = 0; i < found.metallic.size(); ++i) {
      const size_t j = static_cast<size_t>(24 * first) + i;
      EXPECT_EQ(found.metallic[i], whole.metallic[j]);
      EXPECT_EQ(found.ColorAt(i), whole.ColorAt(j));
    }
  }
}

}  // namespace
}  // namespace glint
