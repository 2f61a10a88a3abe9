#include "datasets/procedural/blend.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/cpu/vector_clones.h"
#include "datasets/procedural/families/common.h"

namespace glint::procedural {
namespace {

enum class MaskKind { kConstant, kClouds, kIslands, kTiling, kTone };

struct Mask {
  MaskKind kind;
  NoiseOptions noise;
  Warp warp;
  TilingOptions tiling;
  float level, soft, constant, share, cosine, sine, tone;
};

Mask DrawMask(uint64_t seed) {
  Rng rng(seed);
  Mask m;
  const float kind = rng.Unit();
  m.kind = kind < 0.25f   ? MaskKind::kConstant
           : kind < 0.45f ? MaskKind::kClouds
           : kind < 0.65f ? MaskKind::kIslands
           : kind < 0.8f  ? MaskKind::kTiling
                          : MaskKind::kTone;
  m.noise = DrawNoise(rng, NoiseKind::kSmooth, 0.8f, 6.0f, 4);
  m.warp = DrawWarp(rng, 2.0f, 8.0f, rng.Uniform(0.0f, 0.4f));
  static constexpr Tiling kForms[] = {Tiling::kGrid, Tiling::kRunningBond, Tiling::kHexagon,
                                      Tiling::kVoronoi, Tiling::kBasket};
  m.tiling.tiling = kForms[rng.Int(0, 4)];
  m.tiling.frequency = rng.LogUniform(2.0f, 10.0f);
  m.tiling.aspect = rng.Int(1, 4);
  m.tiling.seed = rng.Seed();
  m.level = rng.Uniform(-0.25f, 0.25f);
  m.soft = m.kind == MaskKind::kClouds || m.kind == MaskKind::kTone ? rng.Uniform(0.25f, 0.8f)
                                                                    : rng.LogUniform(0.01f, 0.15f);
  m.constant = rng.Uniform(0.15f, 0.85f);
  m.share = rng.Uniform(0.25f, 0.75f);
  m.tone = rng.Uniform(0.5f, 2.0f) * (rng.Chance(0.5f) ? 1.0f : -1.0f);
  const float turn = rng.Unit();
  m.cosine = CosTurn(turn);
  m.sine = SinTurn(turn);
  return m;
}

void MaskRow(const Mask& m, const RowDomain& d, Scratch& scratch, float* out) {
  if (m.kind == MaskKind::kConstant) return SetAll(out, d.n, m.constant);
  const float* noise = NoiseRow(m.noise, d, scratch);
  if (m.kind != MaskKind::kTiling) {
    const float soft = std::max(m.soft, 3.0f * m.noise.frequency * d.pixel);
    for (int i = 0; i < d.n; ++i) out[i] = SmoothStep(-soft, soft, noise[i] - m.level);
    return;
  }
  const TilingRows cells = TakeTilingRows(scratch);
  const RowDomain w = Warped(m.warp, d, scratch);
  Tile(m.tiling, w.x, w.y, d.n, cells);
  const float soft = EdgeWidth(0.02f, m.tiling.frequency, d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const float chosen = CellRandom(cells.id[i], 11) < m.share ? 1.0f : 0.0f;
    out[i] = chosen * SmoothStep(0.0f, soft, cells.edge[i] - 0.02f);
  }
}

float MeanOf(std::span<const float> plane) {
  double sum = 0.0;
  for (const float value : plane) sum += value;
  return static_cast<float>(sum / static_cast<double>(plane.size()));
}

// Green diffuse and specular together, less its mean and over its spread.
Plane ToneOf(const SvbrdfMaps& maps) {
  const auto diffuse = maps.plane(kDiffuseG), specular = maps.plane(kSpecularG);
  Plane tone(diffuse.size());
  for (size_t i = 0; i < tone.size(); ++i) tone[i] = diffuse[i] + specular[i];
  const float mean = MeanOf(tone);
  double square = 0.0;
  for (float& value : tone) {
    value -= mean;
    square += static_cast<double>(value) * value;
  }
  const float spread = static_cast<float>(std::sqrt(square / static_cast<double>(tone.size())));
  for (float& value : tone) value /= std::max(spread, 1e-3f);
  return tone;
}

// Lets the noise of a mask follow the first material's tone.
void FollowTone(const Mask& m, const Plane& tone, Plane* mask) {
  for (size_t i = 0; i < tone.size(); ++i) {
    (*mask)[i] = SmoothStep(-0.5f, 0.5f, 2.0f * ((*mask)[i] - 0.5f) + 0.4f * m.tone * tone[i]);
  }
}

GLINT_VECTOR_CLONES
void MixPlanes(const float* from, const float* mask, size_t n, float* __restrict to) {
  for (size_t i = 0; i < n; ++i) {
    const float mixed = Mix(to[i], from[i], mask[i]);  // rounding may pass either end
    to[i] = std::min(std::max(mixed, std::min(to[i], from[i])), std::max(to[i], from[i]));
  }
}

GLINT_VECTOR_CLONES
void MixNormals(const float* from_x, const float* from_y, const float* from_z, const float* mask,
                size_t n, float* __restrict x, float* __restrict y, float* __restrict z) {
  for (size_t i = 0; i < n; ++i) {
    const float sx = Mix(x[i] / z[i], from_x[i] / from_z[i], mask[i]);
    const float sy = Mix(y[i] / z[i], from_y[i] / from_z[i], mask[i]);
    z[i] = 1.0f / std::sqrt(1.0f + sx * sx + sy * sy);
    x[i] = sx * z[i];
    y[i] = sy * z[i];
  }
}

Plane MaskPlane(const Mask& m, int width, int height) {
  const float pixel = 1.0f / static_cast<float>(std::max(width, height));
  Plane mask(static_cast<size_t>(width) * height);
  std::vector<float> x(width), y(width);
  Scratch scratch(width);
  for (int row = 0; row < height; ++row) {
    const float py = (0.5f * static_cast<float>(height) - static_cast<float>(row) - 0.5f) * pixel;
    for (int i = 0; i < width; ++i) {
      const float px = (static_cast<float>(i) + 0.5f - 0.5f * static_cast<float>(width)) * pixel;
      x[i] = m.cosine * px - m.sine * py + 7.3f;
      y[i] = m.sine * px + m.cosine * py + 3.1f;
    }
    scratch.Reset();
    MaskRow(m, {x.data(), y.data(), width, pixel}, scratch,
            mask.data() + static_cast<size_t>(row) * width);
  }
  return mask;
}

}  // namespace

Plane DrawBlendMask(uint64_t seed, const SvbrdfMaps& first) {
  const Mask m = DrawMask(seed);
  Plane mask = MaskPlane(m, first.width, first.height);
  if (m.kind == MaskKind::kTone) FollowTone(m, ToneOf(first), &mask);
  return mask;
}

Plane DrawBlendMask(uint64_t seed, int width, int height) {
  return MaskPlane(DrawMask(seed), width, height);
}

void Reconcile(uint64_t seed, const SvbrdfMaps& first, SvbrdfMaps* second) {
  Rng rng(seed);
  const float colors = rng.Chance(0.8f) ? rng.Unit() : 0.0f;
  const float roughness = rng.Chance(0.8f) ? rng.Uniform(0.3f, 1.0f) : 0.0f;
  for (int p = kDiffuseR; p <= kDiffuseB; ++p) {
    const float from = MeanOf(second->plane(p)), to = MeanOf(first.plane(p));
    if (from < 0.01f || to < 0.01f) continue;  // a metal has no colour to give or take
    const float gain = std::pow(to / from, colors);
    const auto diffuse = second->plane(p), specular = second->plane(p - kDiffuseR + kSpecularR);
    for (size_t i = 0; i < diffuse.size(); ++i) {
      diffuse[i] = std::min(gain * diffuse[i], 1.0f - specular[i]);
    }
  }
  const float change =
      roughness * (MeanOf(first.plane(kRoughness)) - MeanOf(second->plane(kRoughness)));
  for (float& r : second->plane(kRoughness)) r = std::clamp(r + change, 0.05f, 1.0f);
}

SvbrdfMaps BlendMaterials(SvbrdfMaps first, const SvbrdfMaps& second, const Plane& mask) {
  for (int p = kDiffuseR; p < kSvbrdfPlanes; ++p) {
    MixPlanes(second.plane(p).data(), mask.data(), mask.size(), first.plane(p).data());
  }
  const float* from[3] = {second.plane(0).data(), second.plane(1).data(), second.plane(2).data()};
  MixNormals(from[0], from[1], from[2], mask.data(), mask.size(), first.plane(0).data(),
             first.plane(1).data(), first.plane(2).data());
  return first;
}

}  // namespace glint::procedural
