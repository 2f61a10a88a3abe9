#include "fitting/training/training_materials.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "datasets/procedural/blend.h"
#include "datasets/procedural/material.h"
#include "fitting/training/random.h"

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

SvbrdfMaps PackedWindow(const PackedMaterial& material, int size, Stream* random) {
  const int window = size + random->Below(material.size - size + 1);
  const int column = random->Below(material.size - window + 1);
  const int row = random->Below(material.size - window + 1);
  SvbrdfMaps maps = CutMaterial(material, column, row, window, size);
  DrawDielectric(random, &maps);
  if (random->Uniform() < 0.5) ChangeRoughness(random, &maps);
  return maps;
}

// As found, procedural or packed or both.
SvbrdfMaps PlainMaterial(const TrainingMaterialOptions& options, const MaterialPack* pack,
                         std::uint64_t seed, Stream* random) {
  const bool packed = pack != nullptr && !pack->empty() && random->Uniform() < options.pack_share;
  if (!packed) return MakeMaterial(seed, options.size, options.size);
  const PackedMaterial& material =
      (*pack)[static_cast<size_t>(random->Below(static_cast<int>(pack->size())))];
  const SvbrdfMaps maps = PackedWindow(material, options.size, random);
  if (random->Uniform() >= options.mixture_share) return maps;
  const SvbrdfMaps other = MakeMaterial(seed, options.size, options.size);
  return procedural::BlendMaterials(maps, other,
                                    procedural::DrawBlendMask(seed, options.size, options.size));
}

}  // namespace

SvbrdfMaps TrainingMaterial(const TrainingMaterialOptions& options, const MaterialPack* pack,
                            std::uint64_t k) {
  Stream random(StreamSeed(options.seed ^ kChoiceStream, k));
  const std::uint64_t seed = ProceduralSeed(options.seed, k);
  SvbrdfMaps maps = PlainMaterial(options, pack, seed, &random);
  maps = WithGlossyDielectrics(std::move(maps), options.glossy_dielectric_share, seed, &random);
  // Drawn only when asked for, so that trainings of before repeat.
  if (options.one_substance_share <= 0) return maps;
  return OneSubstanceAtTimes(std::move(maps), options.one_substance_share, &random);
}

}  // namespace glint
