// Loose and bound ground: soil, asphalt, sand, board-marked concrete; and ice.
#include "datasets/procedural/families/common.h"
#include "datasets/procedural/families/families.h"

namespace glint::procedural {
namespace {

// Clods, pebbles and puddles.
struct Soil {
  Warp warp;
  NoiseOptions clods, grit, tone;
  float frequency, presence, size;
  uint32_t seed;
  Scheme colors;
  Color pebble;
  float grit_relief, crevice, wet_level, wet_soft, wet_rough, wet_dark, roughness, f0;
};

void SoilRow(Soil p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* clods = NoiseRow(p.clods, w, s);
  const float* grit = NoiseRow(p.grit, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const TilingRows cells = TakeTilingRows(s);
  Voronoi(p.frequency, 0.95f, p.seed, w.x, w.y, d.n, {cells.u, cells.v, cells.edge, cells.id});
  for (int i = 0; i < d.n; ++i) {
    const uint32_t id = cells.id[i];
    const float size = p.size * (0.4f + CellRandom(id, 1));
    const float reach = cells.u[i] * cells.u[i] + cells.v[i] * cells.v[i];
    const float there = CellRandom(id, 2) < p.presence ? 1.0f : 0.0f;
    const float pebble = there * SmoothStep(0.0f, 0.3f, 1.0f - reach / (size * size));
    const float dome = std::sqrt(std::max(1.0f - reach / (size * size), 0.0f));
    const float dry = 1.4f * clods[i] + p.grit_relief * grit[i];
    const float height = Mix(dry, 0.8f * dome + 0.4f, pebble);
    const float wet =
        1.0f - SmoothStep(p.wet_level - p.wet_soft, p.wet_level, height + 0.3f * tone[i]);
    const float t = Clamp01(0.5f + 0.7f * tone[i]);
    const float gain = (1.0f - p.crevice + p.crevice * Clamp01(dry)) * (1.0f + 0.4f * grit[i]) *
                       Mix(1.0f, p.wet_dark, wet);
    const float stone = Mix(1.0f, p.wet_dark, wet) * (0.5f + CellRandom(id, 3) + 0.2f * grit[i]);
    out.height[i] = Mix(height, p.wet_level, 0.9f * wet);
    out.r[i] = Mix(gain * Mix(p.colors.base.r, p.colors.second.r, t), stone * p.pebble.r, pebble);
    out.g[i] = Mix(gain * Mix(p.colors.base.g, p.colors.second.g, t), stone * p.pebble.g, pebble);
    out.b[i] = Mix(gain * Mix(p.colors.base.b, p.colors.second.b, t), stone * p.pebble.b, pebble);
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = Mix(p.roughness - 0.2f * pebble + 0.08f * grit[i], p.wet_rough, wet);
  }
}

// Stones of one size bound by tar or cement, worn where they stand out.
struct Asphalt {
  NoiseOptions unevenness, grain, worn;
  float frequency, presence, gap, stand_out, wear, stone_tone;
  uint32_t seed;
  Color binder, stones[4];
  float roughness, stone_roughness, f0;
};

void AsphaltRow(Asphalt p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* unevenness = NoiseRow(p.unevenness, d, s);
  const float* grain = NoiseRow(p.grain, d, s);
  const float* worn = NoiseRow(p.worn, d, s);
  const TilingRows cells = TakeTilingRows(s);
  Voronoi(p.frequency, 0.9f, p.seed, d.x, d.y, d.n, {cells.u, cells.v, cells.edge, cells.id});
  const float soft = EdgeWidth(0.12f, p.frequency, d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const uint32_t id = cells.id[i];
    const float rise = p.stand_out * (CellRandom(id, 1) - 0.3f);
    const float there = CellRandom(id, 2) < p.presence ? 1.0f : 0.0f;
    const float stone = there * SmoothStep(p.gap, p.gap + soft, cells.edge[i]);
    const float bare = stone * Clamp01(0.4f + p.wear * (worn[i] + rise));
    const Color& c = p.stones[static_cast<int>(3.999f * CellRandom(id, 3))];
    const float gain = 1.0f + p.stone_tone * (CellRandom(id, 4) - 0.5f) + 0.2f * grain[i];
    const float tar = 1.0f + 0.4f * grain[i] + 0.2f * worn[i];
    out.height[i] = 0.5f * unevenness[i] + stone * (0.4f + rise) + 0.15f * grain[i];
    out.r[i] = Mix(p.binder.r * tar, c.r * gain, bare);
    out.g[i] = Mix(p.binder.g * tar, c.g * gain, bare);
    out.b[i] = Mix(p.binder.b * tar, c.b * gain, bare);
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = Mix(p.roughness + 0.1f * grain[i], p.stone_roughness, bare);
  }
}

// Ripples of wind or water, and single grains.
struct Sand {
  Warp warp;
  NoiseOptions ripples, grains, tone;
  Scheme colors;
  float crest, grain_relief, grain_tone, dark_grains, roughness, wet, f0;
};

void SandRow(Sand p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* ripples = NoiseRow(p.ripples, w, s);
  const float* grains = NoiseRow(p.grains, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  for (int i = 0; i < d.n; ++i) {
    const float h = Mix(ripples[i], 1.0f - std::fabs(ripples[i]) * 2.0f, p.crest);
    const float dark = p.dark_grains * SmoothStep(0.35f, 0.55f, grains[i]);
    const float t = Clamp01(0.5f + 0.5f * h + 0.3f * tone[i]);
    const float damp = p.wet * (1.0f - SmoothStep(-0.4f, 0.1f, h + tone[i]));
    const float gain = (1.0f + p.grain_tone * grains[i] - dark) * (1.0f - 0.5f * damp);
    out.height[i] = h + p.grain_relief * grains[i];
    out.r[i] = gain * Mix(p.colors.base.r, p.colors.second.r, t);
    out.g[i] = gain * Mix(p.colors.base.g, p.colors.second.g, t);
    out.b[i] = gain * Mix(p.colors.base.b, p.colors.second.b, t);
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness - 0.6f * damp + 0.1f * grains[i];
  }
}

// Concrete that shows its boards: grain, joints, pores and stains that run down.
struct Formwork {
  TilingOptions boards;
  NoiseOptions grain, pores, tone, runs;
  Scheme colors;
  float grain_depth, step, joint, pore_level, pore_depth, board_tone, run_tone, roughness, f0;
};

void FormworkRow(Formwork p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const TilingRows cells = TakeTilingRows(s);
  Tile(p.boards, d.x, d.y, d.n, cells);
  const float* grain = NoiseRow(p.grain, d, s);
  const float* pores = NoiseRow(p.pores, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const float* runs = NoiseRow(p.runs, d, s);
  const float soft = EdgeWidth(0.02f, p.boards.frequency, d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const float own = CellRandom(cells.id[i], 1) - 0.5f;
    const float joint = 1.0f - SmoothStep(0.0f, soft, cells.edge[i]);
    const float pore = SmoothStep(p.pore_level, p.pore_level + 0.1f, pores[i]);
    const float t = Clamp01(0.5f + 0.8f * tone[i]);
    const float gain = (1.0f + p.board_tone * own + p.run_tone * runs[i] + 0.1f * grain[i]) *
                       (1.0f - 0.5f * pore) * (1.0f - 0.3f * joint);
    out.height[i] = p.grain_depth * grain[i] + p.step * own + p.joint * joint - p.pore_depth * pore;
    out.r[i] = gain * Mix(p.colors.base.r, p.colors.second.r, t);
    out.g[i] = gain * Mix(p.colors.base.g, p.colors.second.g, t);
    out.b[i] = gain * Mix(p.colors.base.b, p.colors.second.b, t);
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness - 0.15f * (gain - 1.0f) + 0.1f * pore;
  }
}

// Clear or frosted: white cracks of three sizes under a smooth or rimy surface.
struct Ice {
  Warp warp;
  NoiseOptions clouds, frost;
  float frequency[3], width[3];
  uint32_t seed[3];
  Color deep, white;
  float crack_tone, cloudiness, frost_level, roughness, frost_roughness, dent, f0;
};

void IceRow(Ice p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* clouds = NoiseRow(p.clouds, w, s);
  const float* frost = NoiseRow(p.frost, d, s);
  const TilingRows cells = TakeTilingRows(s);
  float* crack = s.Row();
  SetAll(crack, d.n, 0.0f);
  for (int layer = 0; layer < 3; ++layer) {
    Voronoi(p.frequency[layer], 1.0f, p.seed[layer], w.x, w.y, d.n,
            {cells.u, cells.v, cells.edge, cells.id});
    const float width = EdgeWidth(p.width[layer], p.frequency[layer], d.pixel);
    for (int i = 0; i < d.n; ++i) {
      const float fade = CellRandom(cells.id[i], 1);
      crack[i] = std::max(crack[i], fade * (1.0f - Clamp01(cells.edge[i] / width)));
    }
  }
  for (int i = 0; i < d.n; ++i) {
    const float rime = SmoothStep(p.frost_level, p.frost_level + 0.3f, clouds[i] + 0.4f * frost[i]);
    const float milk = Clamp01(p.crack_tone * crack[i] + p.cloudiness * (0.5f + clouds[i]));
    const float white = std::max(milk, 0.8f * rime);
    out.height[i] = 0.2f * clouds[i] - p.dent * crack[i] + rime * (0.3f + 0.4f * frost[i]);
    out.r[i] = Mix(p.deep.r, p.white.r, white);
    out.g[i] = Mix(p.deep.g, p.white.g, white);
    out.b[i] = Mix(p.deep.b, p.white.b, white);
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = Mix(p.roughness + 0.1f * crack[i], p.frost_roughness, rime);
  }
}

}  // namespace

RowFunction DrawSoil(Rng& rng) {
  Soil p;
  p.warp = DrawWarp(rng, 3.0f, 15.0f, rng.Uniform(0.0f, 0.5f));
  p.clods =
      DrawNoise(rng, rng.Chance(0.6f) ? NoiseKind::kBillow : NoiseKind::kSmooth, 4.0f, 30.0f, 4);
  p.grit = DrawNoise(rng, NoiseKind::kSmooth, 40.0f, 100.0f, 2);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 8.0f, 4);
  p.frequency = rng.LogUniform(6.0f, 40.0f);
  p.presence = rng.Chance(0.6f) ? rng.Uniform(0.02f, 0.5f) : 0.0f;
  p.size = rng.Uniform(0.2f, 0.5f);
  p.seed = rng.Seed();
  p.colors = DrawScheme(
      rng, [](Rng& r) { return r.Chance(0.8f) ? EarthColor(r) : GreyColor(r); }, 0.5f);
  p.pebble = rng.Chance(0.6f) ? GreyColor(rng) : Related(rng, p.colors.base, 0.9f);
  p.grit_relief = rng.Uniform(0.05f, 0.5f);
  p.crevice = rng.Uniform(0.1f, 0.8f);
  p.wet_level = rng.Chance(0.4f) ? rng.Uniform(-0.1f, 0.6f) : -9.0f;
  p.wet_soft = rng.LogUniform(0.05f, 0.4f);
  p.wet_rough = rng.Uniform(0.05f, 0.35f);
  p.wet_dark = rng.Uniform(0.35f, 0.8f);
  p.roughness = rng.Uniform(0.65f, 0.98f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, SoilRow);
}

RowFunction DrawAsphalt(Rng& rng) {
  Asphalt p;
  p.unevenness = DrawNoise(rng, NoiseKind::kSmooth, 2.0f, 12.0f, 3);
  p.grain = DrawNoise(rng, NoiseKind::kSmooth, 50.0f, 110.0f, 2);
  p.worn = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 6.0f, 4);
  p.frequency = rng.LogUniform(10.0f, 36.0f);
  p.presence = rng.Uniform(0.4f, 1.0f);
  p.gap = rng.Uniform(0.0f, 0.12f);
  p.stand_out = rng.Uniform(0.2f, 1.2f);
  p.wear = rng.Uniform(0.2f, 2.0f);
  p.stone_tone = rng.Uniform(0.2f, 1.0f);
  p.seed = rng.Seed();
  p.binder = ScaleColor(GreyColor(rng), rng.LogUniform(0.15f, 0.9f));
  const Color first = GreyColor(rng);
  for (Color& c : p.stones) c = rng.Chance(0.7f) ? Related(rng, first, 0.7f) : EarthColor(rng);
  p.roughness = rng.Uniform(0.5f, 0.95f);
  p.stone_roughness = AnyRoughness(rng, 0.1f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, AsphaltRow);
}

RowFunction DrawSand(Rng& rng) {
  Sand p;
  p.warp = DrawWarp(rng, 1.5f, 6.0f, rng.Uniform(0.0f, 0.3f));
  p.ripples = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 5.0f, rng.Int(1, 3));
  p.ripples.stretch = rng.LogUniform(2.0f, 9.0f);
  p.grains = DrawNoise(rng, NoiseKind::kSmooth, 70.0f, 120.0f, 1);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 8.0f, 4);
  p.colors = DrawScheme(
      rng, [](Rng& r) { return r.Chance(0.7f) ? EarthColor(r) : GreyColor(r); }, 0.35f);
  p.crest = rng.Unit();
  p.grain_relief = rng.Uniform(0.02f, 0.3f);
  p.grain_tone = rng.Uniform(0.1f, 0.6f);
  p.dark_grains = rng.Chance(0.5f) ? rng.Uniform(0.1f, 0.7f) : 0.0f;
  p.roughness = rng.Uniform(0.6f, 1.0f);
  p.wet = rng.Chance(0.3f) ? rng.Unit() : 0.0f;
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, SandRow);
}

RowFunction DrawFormwork(Rng& rng) {
  Formwork p;
  p.boards.tiling = rng.Chance(0.6f) ? Tiling::kRandomBond : Tiling::kGrid;
  p.boards.frequency = rng.LogUniform(1.5f, 9.0f);
  p.boards.aspect = rng.Int(1, 16);
  p.boards.seed = rng.Seed();
  p.grain = DrawNoise(rng, NoiseKind::kSmooth, 2.0f, 6.0f, 3);
  p.grain.stretch = rng.LogUniform(6.0f, 20.0f);
  p.pores = DrawNoise(rng, NoiseKind::kSmooth, 15.0f, 50.0f, 1);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 6.0f, 5);
  p.runs = DrawNoise(rng, NoiseKind::kSmooth, 4.0f, 16.0f, 3);
  p.runs.stretch = rng.LogUniform(0.08f, 0.4f);
  p.colors = DrawScheme(rng, GreyColor, 0.3f);
  p.grain_depth = rng.Uniform(0.0f, 0.4f);
  p.step = rng.Uniform(0.0f, 0.6f);
  p.joint = rng.Uniform(-0.6f, 0.6f);
  p.pore_level = rng.Uniform(0.4f, 0.7f);
  p.pore_depth = rng.Uniform(0.2f, 1.0f);
  p.board_tone = rng.Uniform(0.0f, 0.4f);
  p.run_tone = rng.Uniform(0.0f, 0.4f);
  p.roughness = rng.Uniform(0.5f, 0.95f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, FormworkRow);
}

RowFunction DrawIce(Rng& rng) {
  Ice p;
  p.warp = DrawWarp(rng, 2.0f, 8.0f, rng.Uniform(0.0f, 0.4f));
  p.clouds = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 6.0f, 5);
  p.frost = DrawNoise(rng, NoiseKind::kRidged, 10.0f, 60.0f, 3);
  float frequency = rng.LogUniform(1.5f, 5.0f);
  for (int layer = 0; layer < 3; ++layer) {
    p.frequency[layer] = frequency;
    p.width[layer] = rng.LogUniform(0.01f, 0.1f);
    p.seed[layer] = rng.Seed();
    frequency *= rng.Uniform(1.7f, 3.0f);
  }
  p.deep = FromHsv(rng.Uniform(0.4f, 0.65f), rng.Uniform(0.1f, 0.8f), rng.LogUniform(0.02f, 0.6f));
  p.white = FromHsv(rng.Uniform(0.45f, 0.65f), rng.Uniform(0.0f, 0.25f), rng.Uniform(0.4f, 0.9f));
  p.crack_tone = rng.Uniform(0.3f, 1.0f);
  p.cloudiness = rng.Uniform(0.0f, 0.8f);
  p.frost_level = rng.Chance(0.6f) ? rng.Uniform(-0.2f, 0.7f) : 9.0f;
  p.roughness = rng.Uniform(0.05f, 0.4f);
  p.frost_roughness = rng.Uniform(0.5f, 0.95f);
  p.dent = rng.Uniform(0.0f, 0.4f);
  p.f0 = rng.Uniform(0.02f, 0.03f);
  return Bind(p, IceRow);
}

}  // namespace glint::procedural
