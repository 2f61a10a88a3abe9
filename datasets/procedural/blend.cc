#include "datasets/procedural/blend.h"

#include <cmath>

#include "datasets/procedural/families/common.h"

namespace glint::procedural {
namespace {

enum class MaskKind { kConstant, kClouds, kIslands, kTiling };

struct Mask {
  MaskKind kind;
  NoiseOptions noise;
  Warp warp;
  TilingOptions tiling;
  float level, soft, constant, share, cosine, sine;
};

Mask DrawMask(uint64_t seed) {
  Rng rng(seed);
  Mask m;
  const float kind = rng.Unit();
  m.kind = kind < 0.2f    ? MaskKind::kConstant
           : kind < 0.45f ? MaskKind::kClouds
           : kind < 0.8f  ? MaskKind::kIslands
                          : MaskKind::kTiling;
  m.noise = DrawNoise(rng, NoiseKind::kSmooth, 0.8f, 6.0f, 4);
  m.warp = DrawWarp(rng, 2.0f, 8.0f, rng.Uniform(0.0f, 0.4f));
  static constexpr Tiling kForms[] = {Tiling::kGrid, Tiling::kRunningBond, Tiling::kHexagon,
                                      Tiling::kVoronoi, Tiling::kBasket};
  m.tiling.tiling = kForms[rng.Int(0, 4)];
  m.tiling.frequency = rng.LogUniform(2.0f, 10.0f);
  m.tiling.aspect = rng.Int(1, 4);
  m.tiling.seed = rng.Seed();
  m.level = rng.Uniform(-0.25f, 0.25f);
  m.soft = m.kind == MaskKind::kClouds ? rng.Uniform(0.25f, 0.8f) : rng.LogUniform(0.01f, 0.15f);
  m.constant = rng.Uniform(0.15f, 0.85f);
  m.share = rng.Uniform(0.25f, 0.75f);
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

}  // namespace

std::vector<float> DrawBlendMask(uint64_t seed, int width, int height) {
  const Mask m = DrawMask(seed);
  const float pixel = 1.0f / static_cast<float>(std::max(width, height));
  std::vector<float> mask(static_cast<size_t>(width) * height);
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

SvbrdfMaps BlendMaterials(const SvbrdfMaps& first, const SvbrdfMaps& second,
                          const std::vector<float>& mask) {
  SvbrdfMaps out(first.width, first.height);
  const size_t n = mask.size();
  for (int p = kDiffuseR; p < kSvbrdfPlanes; ++p) {
    const float* a = first.plane(p).data();
    const float* b = second.plane(p).data();
    float* to = out.plane(p).data();
    for (size_t i = 0; i < n; ++i) {
      const float mixed = Mix(a[i], b[i], mask[i]);  // rounding may pass either end
      to[i] = std::min(std::max(mixed, std::min(a[i], b[i])), std::max(a[i], b[i]));
    }
  }
  const float* a[3] = {first.plane(0).data(), first.plane(1).data(), first.plane(2).data()};
  const float* b[3] = {second.plane(0).data(), second.plane(1).data(), second.plane(2).data()};
  float* to[3] = {out.plane(0).data(), out.plane(1).data(), out.plane(2).data()};
  for (size_t i = 0; i < n; ++i) {
    const float sx = Mix(a[0][i] / a[2][i], b[0][i] / b[2][i], mask[i]);
    const float sy = Mix(a[1][i] / a[2][i], b[1][i] / b[2][i], mask[i]);
    const float z = 1.0f / std::sqrt(1.0f + sx * sx + sy * sy);
    to[0][i] = sx * z;
    to[1][i] = sy * z;
    to[2][i] = z;
  }
  return out;
}

}  // namespace glint::procedural
