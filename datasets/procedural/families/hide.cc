// Skins and skins' imitations: leather, scales, crumpled foil and paper.
#include "datasets/procedural/families/common.h"
#include "datasets/procedural/families/families.h"

namespace glint::procedural {
namespace {

struct Leather {
  Warp warp;
  NoiseOptions wrinkles, tone, grain;
  float frequency, second_frequency, jitter, stretch, dome, second_mix, wrinkle_depth;
  uint32_t seed, second_seed;
  Scheme colors;
  float crease_dark, wear, worn_level, roughness, crease_roughness, f0;
};

void LeatherRow(Leather p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const RowDomain k = Stretched(w, 1.0f, p.stretch, s);
  const float* wrinkles = NoiseRow(p.wrinkles, w, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const float* grain = NoiseRow(p.grain, d, s);
  const TilingRows big = TakeTilingRows(s), small = TakeTilingRows(s);
  Voronoi(p.frequency, p.jitter, p.seed, k.x, k.y, d.n, {big.u, big.v, big.edge, big.id});
  Voronoi(p.second_frequency, p.jitter, p.second_seed, k.x, k.y, d.n,
          {small.u, small.v, small.edge, small.id});
  for (int i = 0; i < d.n; ++i) {
    const float cell = SmoothStep(0.0f, p.dome, big.edge[i]);
    const float pebble = SmoothStep(0.0f, p.dome, small.edge[i]);
    const float fold = SmoothStep(0.75f, 1.0f, wrinkles[i]);
    const float h = Mix(cell, cell * (0.5f + 0.5f * pebble), p.second_mix) - p.wrinkle_depth * fold;
    const float crease = Clamp01(1.0f - h);
    const float worn = p.wear * SmoothStep(p.worn_level, p.worn_level + 0.3f, tone[i]) * Clamp01(h);
    const float t = Clamp01(0.45f + 0.6f * tone[i] + 0.2f * (CellRandom(big.id[i], 1) - 0.5f));
    const float gain = (1.0f - p.crease_dark * crease) * (1.0f + 0.15f * grain[i]);
    out.height[i] = h + 0.05f * grain[i];
    out.r[i] =
        Clamp01(Mix(gain * Mix(p.colors.base.r, p.colors.second.r, t), p.colors.third.r, worn));
    out.g[i] =
        Clamp01(Mix(gain * Mix(p.colors.base.g, p.colors.second.g, t), p.colors.third.g, worn));
    out.b[i] =
        Clamp01(Mix(gain * Mix(p.colors.base.b, p.colors.second.b, t), p.colors.third.b, worn));
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness + p.crease_roughness * crease + 0.25f * worn + 0.1f * tone[i];
  }
}

struct Scales {
  Warp warp;
  NoiseOptions grain, tone;
  float frequency, aspect, overlap, ridge, tilt, pointed;
  uint32_t seed;
  Scheme colors;
  float cell_tone, rim_dark, roughness, cell_roughness, f0, metal;
};

// One staggered row of shields; true where the point lies on the shield of that row.
struct Shield {
  bool inside;
  float rim;    // 0 on the free border, 1 at the shield's middle
  float depth;  // 0 at the free border's tip, growing toward the covered end
  float side;
  uint32_t id;
};

inline Shield ShieldAt(const Scales& p, float px, float py, int32_t row) {
  const float shift = (row & 1) != 0 ? 0.5f : 0.0f;
  const int32_t column = FloorInt(px + shift);
  const float u = px + shift - static_cast<float>(column) - 0.5f;
  const float v = py - static_cast<float>(row);  // 0 at the tip, 1 + overlap at the covered end
  const float a = 2.0f * std::fabs(u);
  const float round = 1.0f - std::sqrt(std::max(1.0f - a * a, 0.0f));
  const float border = p.overlap * Mix(round, a, p.pointed);
  const float in = v - border;
  return {in > 0.0f, Clamp01(in * 3.0f), v, u, Hash2(column, row, p.seed)};
}

void ScalesRow(Scales p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* grain = NoiseRow(p.grain, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  for (int i = 0; i < d.n; ++i) {
    const float px = w.x[i] * p.frequency, py = w.y[i] * p.frequency * p.aspect;
    const int32_t row = FloorInt(py);
    const Shield front = ShieldAt(p, px, py, row), back = ShieldAt(p, px, py, row - 1);
    const Shield& top = front.inside ? front : back;
    const float ridge = p.ridge * (1.0f - std::min(5.0f * std::fabs(top.side), 1.0f));
    const float own = CellRandom(top.id, 1) - 0.5f;
    const float gain = (1.0f + p.cell_tone * own) * (1.0f + 0.3f * grain[i]) *
                       (1.0f - p.rim_dark * (1.0f - top.rim));
    const float t = Clamp01(0.5f + 0.7f * tone[i]);
    out.height[i] = 0.4f * top.rim + ridge - p.tilt * top.depth + 0.04f * grain[i];
    out.r[i] = Clamp01(gain * Mix(p.colors.base.r, p.colors.second.r, t));
    out.g[i] = Clamp01(gain * Mix(p.colors.base.g, p.colors.second.g, t));
    out.b[i] = Clamp01(gain * Mix(p.colors.base.b, p.colors.second.b, t));
    out.metal[i] = p.metal;
    out.f0[i] = p.f0;
    out.roughness[i] =
        p.roughness + p.cell_roughness * own + 0.15f * (1.0f - top.rim) + 0.1f * grain[i];
  }
}

struct Crumple {
  Warp warp;
  NoiseOptions tone, bumps;
  float frequency[3], depth[3], tilt;
  uint32_t seed[3];
  Scheme colors;
  float crease_tone, roughness, roughness_spread, f0, metal;
};

void CrumpleRow(Crumple p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const float* bumps = NoiseRow(p.bumps, d, s);
  const TilingRows cells = TakeTilingRows(s);
  float* crease = s.Row();
  SetAll(crease, d.n, 0.0f);
  SetAll(out.height, d.n, 0.0f);
  for (int layer = 0; layer < 3; ++layer) {
    Voronoi(p.frequency[layer], 1.0f, p.seed[layer], w.x, w.y, d.n,
            {cells.u, cells.v, cells.edge, cells.id});
    for (int i = 0; i < d.n; ++i) {
      const float cone = std::sqrt(cells.u[i] * cells.u[i] + cells.v[i] * cells.v[i]);
      const float roof = Mix(cone, std::min(cells.edge[i], 0.3f), p.tilt);
      out.height[i] += p.depth[layer] * roof;
      crease[i] = std::max(crease[i], 1.0f - Clamp01(8.0f * cells.edge[i]));
    }
  }
  for (int i = 0; i < d.n; ++i) {
    const float t = Clamp01(0.5f + 0.6f * tone[i]);
    const float gain = 1.0f + p.crease_tone * crease[i];
    out.height[i] += 0.02f * bumps[i];
    out.r[i] = Clamp01(gain * Mix(p.colors.base.r, p.colors.second.r, t));
    out.g[i] = Clamp01(gain * Mix(p.colors.base.g, p.colors.second.g, t));
    out.b[i] = Clamp01(gain * Mix(p.colors.base.b, p.colors.second.b, t));
    out.metal[i] = p.metal;
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness + p.roughness_spread * (crease[i] + 0.5f * tone[i]);
  }
}

}  // namespace

RowFunction DrawLeather(Rng& rng) {
  Leather p;
  p.warp = DrawWarp(rng, 2.0f, 10.0f, rng.Uniform(0.0f, 0.5f));
  p.wrinkles = DrawNoise(rng, NoiseKind::kRidged, 1.5f, 8.0f, 2);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.2f, 8.0f, 5);
  p.grain = DrawNoise(rng, NoiseKind::kSmooth, 40.0f, 110.0f, 2);
  p.frequency = rng.LogUniform(8.0f, 60.0f);
  p.second_frequency = p.frequency * rng.Uniform(1.6f, 3.0f);
  p.jitter = rng.Uniform(0.6f, 1.0f);
  p.stretch = rng.Chance(0.6f) ? 1.0f : rng.LogUniform(0.4f, 2.5f);
  p.dome = rng.Uniform(0.1f, 0.5f);
  p.second_mix = rng.Chance(0.6f) ? rng.Unit() : 0.0f;
  p.wrinkle_depth = rng.Chance(0.5f) ? rng.Uniform(0.0f, 0.8f) : 0.0f;
  p.seed = rng.Seed();
  p.second_seed = rng.Seed();
  p.colors = DrawScheme(
      rng, [](Rng& r) { return r.Chance(0.5f) ? EarthColor(r) : AnyColor(r); }, 0.4f);
  p.crease_dark = rng.Uniform(0.0f, 0.7f);
  p.wear = rng.Chance(0.5f) ? rng.Unit() : 0.0f;
  p.worn_level = rng.Uniform(0.0f, 0.3f);
  p.roughness = AnyRoughness(rng, -0.1f);
  p.crease_roughness = rng.Uniform(-0.1f, 0.35f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, LeatherRow);
}

RowFunction DrawScales(Rng& rng) {
  Scales p;
  p.warp = DrawWarp(rng, 2.0f, 8.0f, rng.Uniform(0.0f, 0.12f));
  p.grain = DrawNoise(rng, NoiseKind::kSmooth, 15.0f, 80.0f, 3);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 10.0f, 4);
  p.frequency = rng.LogUniform(4.0f, 22.0f);
  p.aspect = rng.LogUniform(0.7f, 2.2f);
  p.overlap =
      rng.Chance(0.3f) ? rng.Uniform(0.0f, 0.1f) : rng.Uniform(0.4f, 0.95f);  // slates, scales
  p.ridge = rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.6f) : 0.0f;
  p.tilt = rng.Uniform(0.0f, 0.8f);
  p.pointed = rng.Chance(0.3f) ? rng.Unit() : 0.0f;
  p.seed = rng.Seed();
  const bool metal = rng.Chance(0.2f);
  p.colors = metal ? DrawScheme(rng, MetalColor, 0.15f) : DrawScheme(rng, AnyColor, 0.5f);
  p.metal = metal ? 1.0f : 0.0f;
  p.cell_tone = rng.Uniform(0.0f, 0.8f);
  p.rim_dark = rng.Uniform(0.0f, 0.7f);
  p.roughness = AnyRoughness(rng, -0.1f);
  p.cell_roughness = rng.Uniform(0.0f, 0.3f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, ScalesRow);
}

RowFunction DrawCrumple(Rng& rng) {
  Crumple p;
  p.warp = DrawWarp(rng, 2.0f, 8.0f, rng.Uniform(0.0f, 0.3f));
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 12.0f, 4);
  p.bumps = DrawNoise(rng, NoiseKind::kSmooth, 20.0f, 80.0f, 2);
  float frequency = rng.LogUniform(1.5f, 5.0f);
  float depth = 1.0f;
  for (int layer = 0; layer < 3; ++layer) {
    p.frequency[layer] = frequency;
    p.depth[layer] = depth / frequency;
    p.seed[layer] = rng.Seed();
    frequency *= rng.Uniform(1.8f, 3.2f);
    depth *= rng.Uniform(0.3f, 1.0f);
  }
  p.tilt = rng.Unit();
  const bool metal = rng.Chance(0.4f);
  p.colors = metal ? DrawScheme(rng, MetalColor, 0.05f) : DrawScheme(rng, AnyColor, 0.2f);
  p.metal = metal ? 1.0f : 0.0f;
  p.crease_tone = metal ? 0.0f : rng.Uniform(-0.3f, 0.3f);
  p.roughness = AnyRoughness(rng, metal ? -0.5f : 0.2f);
  p.roughness_spread = rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.2f) : 0.0f;
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, CrumpleRow);
}

}  // namespace glint::procedural
