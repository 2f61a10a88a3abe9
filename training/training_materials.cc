#include "training/training_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "datasets/procedural/blend.h"
#include "datasets/procedural/material.h"
#include "training/random.h"

namespace glint {
namespace {

constexpr std::uint64_t kChoiceStream = 0x5EED0003;
constexpr float kDielectricF0 = 0.04f;
// Of dark dielectrics, that are rough: felt, rubber, asphalt.
constexpr double kMatteShare = 0.35;
constexpr float kMetalF0 = 0.12f;  // above it, specular is a metal's colour and stays

// Each training draws its materials from a stretch of its own below the reserved seeds.
std::uint64_t ProceduralSeed(std::uint64_t seed, std::uint64_t k) {
  return (seed * 10'000'019 + k) % kReservedSeedBase;
}

double DrawF0(Stream* random) {
  if (random->Uniform() < 0.15) return 0.08 / random->Uniform(0.35, 1.0);
  return random->Uniform(0.02, 0.08);
}

// Collections store no F0: every dielectric texel has 0.04. What part of a texel is metal is seen
// from how far it is above that.
void DrawDielectric(Stream* random, SvbrdfMaps* maps) {
  const auto f0 = static_cast<float>(DrawF0(random));
  for (int c = 0; c < 3; ++c) {
    for (float& s : maps->plane(kSpecularR + c)) {
      const float metal = std::clamp((s - kDielectricF0) / (kMetalF0 - kDielectricF0), 0.0f, 1.0f);
      s = metal * s + (1 - metal) * std::max(0.0f, s + f0 - kDielectricF0);
    }
  }
}

void ChangeRoughness(Stream* random, SvbrdfMaps* maps) {
  const auto gain = static_cast<float>(random->Uniform(0.4, 1.2));
  const auto contrast = static_cast<float>(random->Uniform(0.6, 2.5));
  double mean = 0;
  for (const float r : maps->plane(kRoughness)) mean += r;
  mean /= static_cast<double>(maps->texels());
  for (float& r : maps->plane(kRoughness)) {
    const float changed =
        gain * (static_cast<float>(mean) + contrast * (r - static_cast<float>(mean)));
    r = std::clamp(changed, 0.05f, 1.0f);
  }
}

void FlattenNormal(float share_left, size_t texel, SvbrdfMaps* maps) {
  float& x = maps->plane(kNormalX)[texel];
  float& y = maps->plane(kNormalY)[texel];
  float& z = maps->plane(kNormalZ)[texel];
  x *= share_left;
  y *= share_left;
  const float inverse = 1 / std::sqrt(x * x + y * y + z * z);
  x *= inverse;
  y *= inverse;
  z *= inverse;
}

// A dark finish of the same pattern, mostly smooth and glossy: glass, lacquer, ink, polish. The
// generator's dark and glossy texels are metals by 70 %, and a photograph does not tell a black
// mirror of F0 = .04 from one of .8; things that people photograph are mostly not metal.
SvbrdfMaps GlossyDielectric(SvbrdfMaps maps, Stream* random) {
  const auto f0 = static_cast<float>(DrawF0(random));
  const auto dark = static_cast<float>(std::exp(random->Uniform(std::log(0.01), std::log(0.7))));
  const bool matte = random->Uniform() < kMatteShare;
  const auto gloss =
      static_cast<float>(matte ? random->Uniform(0.8, 1.5) : random->Uniform(0.15, 0.7));
  const auto relief = static_cast<float>(matte ? 1.0 : random->Uniform(0.1, 1.0));
  for (size_t i = 0; i < maps.texels(); ++i) {
    for (int c = 0; c < 3; ++c) {
      maps.plane(kDiffuseR + c)[i] *= dark;
      maps.plane(kSpecularR + c)[i] = f0;
    }
    float& roughness = maps.plane(kRoughness)[i];
    roughness = std::clamp(gloss * roughness, 0.05f, 1.0f);
    FlattenNormal(relief, i, &maps);
  }
  return maps;
}

// Now and then a glossy dielectric, as a whole or in places.
SvbrdfMaps WithGlossyDielectrics(SvbrdfMaps maps, double share, std::uint64_t seed,
                                 Stream* random) {
  if (random->Uniform() >= share) return maps;
  SvbrdfMaps glossy = GlossyDielectric(maps, random);
  if (random->Uniform() < 0.4) return glossy;
  const procedural::Plane mask = procedural::DrawBlendMask(seed, maps);
  return procedural::BlendMaterials(std::move(maps), glossy, mask);
}

// The plane's values drawn toward their mean.
void DrawTogether(float share_left, std::span<float> plane) {
  double mean = 0;
  for (const float x : plane) mean += x;
  mean /= static_cast<double>(plane.size());
  for (float& x : plane) {
    x = static_cast<float>(mean) + share_left * (x - static_cast<float>(mean));
  }
}

SvbrdfMaps OneSubstanceAtTimes(SvbrdfMaps maps, double share, Stream* random) {
  if (random->Uniform() >= share) return maps;
  const auto left = static_cast<float>(random->Uniform(0, 0.2));
  for (int c = 0; c < 3; ++c) DrawTogether(left, maps.plane(kSpecularR + c));
  DrawTogether(left, maps.plane(kRoughness));
  return maps;
}

// Metal becomes paint or plastic of its colour.
SvbrdfMaps WithoutMetal(SvbrdfMaps maps, Stream* random) {
  const auto f0 = static_cast<float>(DrawF0(random));
  const auto paint = static_cast<float>(random->Uniform(0.3, 1.0));
  for (size_t i = 0; i < maps.texels(); ++i) {
    float most = 0;
    for (int c = 0; c < 3; ++c) most = std::max(most, maps.plane(kSpecularR + c)[i]);
    const float metal = std::clamp((most - kMetalF0) / (kLeastMetalF0 - kMetalF0), 0.0f, 1.0f);
    for (int c = 0; c < 3; ++c) {
      float& diffuse = maps.plane(kDiffuseR + c)[i];
      float& specular = maps.plane(kSpecularR + c)[i];
      diffuse = std::min(1 - f0, diffuse + metal * paint * specular);
      specular += metal * (f0 - specular);
    }
  }
  return maps;
}

// A material and whether it is wood or painted, which people varnish.
struct NamedMaterial {
  SvbrdfMaps maps;
  bool wood_or_paint = false;
};

// By the names that packs give their materials; families tell it themselves.
bool IsPackedWoodOrPaint(const std::string& name) {
  static const std::array<const char*, 9> kNames{"wood",    "Wood",          "planks",
                                                 "Planks",  "chipboard",     "impasto",
                                                 "stripes", "peeling_paint", "Paint"};
  return std::any_of(kNames.begin(), kNames.end(),
                     [&](const char* part) { return name.find(part) != std::string::npos; });
}

// A clear coat: its own smooth reflection from a surface that levels the relief, over a ground that
// it makes darker and more saturated, as if wet.
SvbrdfMaps Varnished(SvbrdfMaps maps, Stream* random) {
  const auto f0 = static_cast<float>(random->Uniform(0.035, 0.05));
  const auto roughness = static_cast<float>(random->Uniform(0.05, 0.3));
  const auto relief = static_cast<float>(random->Uniform(0, 0.4));
  const auto wet = static_cast<float>(random->Uniform(1, 1.3));
  constexpr float kRoughnessLeft = 0.1f;  // of the ground's variation
  DrawTogether(kRoughnessLeft, maps.plane(kRoughness));
  double mean = 0;
  for (const float r : maps.plane(kRoughness)) mean += r;
  mean /= static_cast<double>(maps.texels());
  for (size_t i = 0; i < maps.texels(); ++i) {
    for (int c = 0; c < 3; ++c) {
      float& diffuse = maps.plane(kDiffuseR + c)[i];
      diffuse = std::min(1 - f0, std::pow(diffuse, wet));
      maps.plane(kSpecularR + c)[i] = f0;
    }
    float& r = maps.plane(kRoughness)[i];
    r = std::clamp(roughness + r - static_cast<float>(mean), 0.05f, 1.0f);
    FlattenNormal(relief, i, &maps);
  }
  return maps;
}

SvbrdfMaps VarnishedAtTimes(NamedMaterial material, double share, Stream* random) {
  constexpr double kElsewhere = 0.2;
  if (random->Uniform() >= share * (material.wood_or_paint ? 1 : kElsewhere)) return material.maps;
  if (HasMetal(material.maps)) return material.maps;
  return Varnished(std::move(material.maps), random);
}

SvbrdfMaps PackedWindow(const PackedMaterial& material, int size, Stream* random) {
  const int window = size + random->Below(material.size - size + 1);
  const int column = random->Below(material.size - window + 1);
  const int row = random->Below(material.size - window + 1);
  SvbrdfMaps maps = CutMaterial(material, column, row, window, size);
  DrawDielectric(random, &maps);
  if (random->Uniform() < 0.5) ChangeRoughness(random, &maps);
  return maps;
}

NamedMaterial Procedural(std::uint64_t seed, int size) {
  const MaterialRecipe recipe = DrawRecipe(seed);
  return {MakeMaterial(recipe, size, size), IsWoodOrPaint(recipe.family)};
}

// As found, procedural or packed or both.
NamedMaterial PlainMaterial(const TrainingMaterialOptions& options, const MaterialPack* pack,
                            std::uint64_t seed, Stream* random) {
  const bool packed = pack != nullptr && !pack->empty() && random->Uniform() < options.pack_share;
  if (!packed) return Procedural(seed, options.size);
  const PackedMaterial& material =
      (*pack)[static_cast<size_t>(random->Below(static_cast<int>(pack->size())))];
  const bool wood_or_paint = IsPackedWoodOrPaint(material.name);
  const SvbrdfMaps maps = PackedWindow(material, options.size, random);
  if (random->Uniform() >= options.mixture_share) return {maps, wood_or_paint};
  const SvbrdfMaps other = MakeMaterial(seed, options.size, options.size);
  return {procedural::BlendMaterials(maps, other,
                                     procedural::DrawBlendMask(seed, options.size, options.size)),
          wood_or_paint};
}

// The same with the wanted odds of metal. One with metal is looked for among small pictures of
// procedural ones: the same material at any size.
NamedMaterial MaterialWithMetalOdds(const TrainingMaterialOptions& options,
                                    const MaterialPack* pack, std::uint64_t seed, Stream* random) {
  constexpr int kTries = 32, kSmall = 32;
  const bool metal = random->Uniform() < options.metal_share;
  NamedMaterial material = PlainMaterial(options, pack, seed, random);
  if (HasMetal(material.maps) == metal) return material;
  if (!metal) {
    return {WithoutMetal(std::move(material.maps), random), material.wood_or_paint};
  }
  for (int k = 0; k < kTries; ++k) {
    const std::uint64_t other = random->Bits() % kReservedSeedBase;
    if (HasMetal(MakeMaterial(other, kSmall, kSmall))) return Procedural(other, options.size);
  }
  return material;
}

}  // namespace

bool HasMetal(const SvbrdfMaps& maps) {
  size_t metal = 0;
  for (size_t i = 0; i < maps.texels(); ++i) {
    float most = 0;
    for (int c = 0; c < 3; ++c) most = std::max(most, maps.plane(kSpecularR + c)[i]);
    metal += most > kLeastMetalF0;
  }
  return static_cast<double>(metal) > kLeastMetalShare * static_cast<double>(maps.texels());
}

SvbrdfMaps TrainingMaterial(const TrainingMaterialOptions& options, const MaterialPack* pack,
                            std::uint64_t k) {
  Stream random(StreamSeed(options.seed ^ kChoiceStream, k));
  const std::uint64_t seed = ProceduralSeed(options.seed, k);
  // What is new is drawn only when asked for, so that trainings of before repeat.
  NamedMaterial material = options.metal_share < 0
                               ? PlainMaterial(options, pack, seed, &random)
                               : MaterialWithMetalOdds(options, pack, seed, &random);
  // Odds of metal that were asked for stay.
  if (options.metal_share < 0 || !HasMetal(material.maps)) {
    material.maps = WithGlossyDielectrics(std::move(material.maps), options.glossy_dielectric_share,
                                          seed, &random);
  }
  if (options.one_substance_share > 0) {
    material.maps =
        OneSubstanceAtTimes(std::move(material.maps), options.one_substance_share, &random);
  }
  if (options.varnish_share <= 0) return material.maps;
  return VarnishedAtTimes(std::move(material), options.varnish_share, &random);
}

}  // namespace glint
