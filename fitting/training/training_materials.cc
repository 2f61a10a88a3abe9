#include "fitting/training/training_materials.h"

#include <algorithm>
#include <cmath>

#include "datasets/procedural/blend.h"
#include "datasets/procedural/material.h"
#include "fitting/training/random.h"

namespace glint {
namespace {

constexpr std::uint64_t kChoiceStream = 0x5EED0003;
constexpr float kDielectricF0 = 0.04f;
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

SvbrdfMaps PackedWindow(const PackedMaterial& material, int size, Stream* random) {
  const int window = size + random->Below(material.size - size + 1);
  const int column = random->Below(material.size - window + 1);
  const int row = random->Below(material.size - window + 1);
  SvbrdfMaps maps = CutMaterial(material, column, row, window, size);
  DrawDielectric(random, &maps);
  if (random->Uniform() < 0.5) ChangeRoughness(random, &maps);
  return maps;
}

}  // namespace

SvbrdfMaps TrainingMaterial(const TrainingMaterialOptions& options, const MaterialPack* pack,
                            std::uint64_t k) {
  Stream random(StreamSeed(options.seed ^ kChoiceStream, k));
  const std::uint64_t seed = ProceduralSeed(options.seed, k);
  const bool packed = pack != nullptr && !pack->empty() && random.Uniform() < options.pack_share;
  if (!packed) return MakeMaterial(seed, options.size, options.size);
  const PackedMaterial& material =
      (*pack)[static_cast<size_t>(random.Below(static_cast<int>(pack->size())))];
  const SvbrdfMaps maps = PackedWindow(material, options.size, &random);
  if (random.Uniform() >= options.mixture_share) return maps;
  const SvbrdfMaps other = MakeMaterial(seed, options.size, options.size);
  return procedural::BlendMaterials(maps, other,
                                    procedural::DrawBlendMask(seed, options.size, options.size));
}

}  // namespace glint
