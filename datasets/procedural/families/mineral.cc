// Stone and what is made of it.
#include "datasets/procedural/families/common.h"
#include "datasets/procedural/families/families.h"

namespace glint::procedural {
namespace {

struct Stone {
  NoiseOptions relief, tone, patches, pits;
  Scheme colors;
  float pit_level, pit_depth, tone_by_height, tone_contrast, patch_contrast;
  float roughness, roughness_spread, f0;
};

void StoneRow(Stone p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* relief = NoiseRow(p.relief, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const float* patches = NoiseRow(p.patches, d, s);
  const float* pits = NoiseRow(p.pits, d, s);
  for (int i = 0; i < d.n; ++i) {
    const float pit = SmoothStep(p.pit_level, p.pit_level + 0.12f, pits[i]);
    const float h = relief[i] - p.pit_depth * pit;
    const float t = Clamp01(0.5f + p.tone_contrast * tone[i] + p.tone_by_height * relief[i]);
    const float q = SmoothStep(-p.patch_contrast, p.patch_contrast, patches[i] + 0.3f * tone[i]);
    const float dark = 1.0f - 0.5f * pit;
    out.height[i] = h;
    out.r[i] = dark * Mix(Mix(p.colors.base.r, p.colors.second.r, t), p.colors.third.r, 0.6f * q);
    out.g[i] = dark * Mix(Mix(p.colors.base.g, p.colors.second.g, t), p.colors.third.g, 0.6f * q);
    out.b[i] = dark * Mix(Mix(p.colors.base.b, p.colors.second.b, t), p.colors.third.b, 0.6f * q);
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness + p.roughness_spread * (tone[i] - 0.5f * relief[i]) + 0.1f * pit;
  }
}

struct Marble {
  Warp warp;
  NoiseOptions body, veins, fine_veins;
  Scheme colors;
  float vein_width, fine_width, vein_strength, fine_strength, roughness, vein_roughness, f0, dent,
      cloudy;
};

void MarbleRow(Marble p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* body = NoiseRow(p.body, w, s);
  const float* veins = NoiseRow(p.veins, w, s);
  const float* fine = NoiseRow(p.fine_veins, w, s);
  for (int i = 0; i < d.n; ++i) {
    const float breaks = SmoothStep(-0.7f, 0.3f, body[i]);
    const float v = p.vein_strength * breaks * SmoothStep(1.0f - p.vein_width, 1.0f, veins[i]);
    const float f = p.fine_strength * SmoothStep(1.0f - p.fine_width, 1.0f, fine[i]);
    const float vein = std::max(v, f);
    const float cloud = Clamp01(0.5f + p.cloudy * body[i]);
    out.height[i] = -p.dent * vein + 0.05f * body[i];
    out.r[i] = Mix(Mix(p.colors.base.r, p.colors.second.r, cloud), p.colors.third.r, vein);
    out.g[i] = Mix(Mix(p.colors.base.g, p.colors.second.g, cloud), p.colors.third.g, vein);
    out.b[i] = Mix(Mix(p.colors.base.b, p.colors.second.b, cloud), p.colors.third.b, vein);
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness + p.vein_roughness * vein + 0.04f * body[i];
  }
}

struct Terrazzo {
  float frequency[2], presence[2], inset[2];
  uint32_t seed[2];
  Color binder, chips[4];
  NoiseOptions grain;
  Warp warp;
  float roughness, chip_gloss, f0, chip_rise;
};

void TerrazzoRow(Terrazzo p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* grain = NoiseRow(p.grain, d, s);
  const RowDomain w = Warped(p.warp, d, s);
  const TilingRows cells = TakeTilingRows(s);
  for (int i = 0; i < d.n; ++i) {
    SetColor(out, i, ScaleColor(p.binder, 1.0f + 0.35f * grain[i]));
    out.height[i] = 0.1f * grain[i];
    out.roughness[i] = p.roughness + 0.1f * grain[i];
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
  }
  for (int layer = 0; layer < 2; ++layer) {
    Voronoi(p.frequency[layer], 0.85f, p.seed[layer], w.x, w.y, d.n,
            {cells.u, cells.v, cells.edge, cells.id});
    const float soft = EdgeWidth(0.03f, p.frequency[layer], d.pixel);
    for (int i = 0; i < d.n; ++i) {
      const uint32_t id = cells.id[i];
      if (CellRandom(id, 1) > p.presence[layer]) continue;
      const float inset = p.inset[layer] * (0.4f + 1.2f * CellRandom(id, 2));
      const float chip = SmoothStep(inset - 0.5f * soft, inset + 0.5f * soft, cells.edge[i]);
      const Color& c = p.chips[static_cast<int>(3.999f * CellRandom(id, 3))];
      const float gain = 0.75f + 0.5f * CellRandom(id, 4) + 0.2f * grain[i];
      out.r[i] = Mix(out.r[i], Clamp01(c.r * gain), chip);
      out.g[i] = Mix(out.g[i], Clamp01(c.g * gain), chip);
      out.b[i] = Mix(out.b[i], Clamp01(c.b * gain), chip);
      out.height[i] = Mix(out.height[i], p.chip_rise + 0.05f * grain[i], chip);
      const float gloss = p.chip_gloss * CellRandom(id, 5);
      out.roughness[i] = Mix(out.roughness[i], p.roughness - gloss, chip);
    }
  }
}

struct Gravel {
  float frequency, jitter, dome, gap, tilt, small_frequency;
  uint32_t seed, small_seed;
  Color pebbles[4], ground;
  NoiseOptions grain;
  Warp warp;
  float roughness, wet, f0;
};

void GravelRow(Gravel p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* grain = NoiseRow(p.grain, d, s);
  const RowDomain w = Warped(p.warp, d, s);
  const TilingRows big = TakeTilingRows(s), small = TakeTilingRows(s);
  Voronoi(p.frequency, p.jitter, p.seed, w.x, w.y, d.n, {big.u, big.v, big.edge, big.id});
  Voronoi(p.small_frequency, 0.9f, p.small_seed, w.x, w.y, d.n,
          {small.u, small.v, small.edge, small.id});
  const float ratio = p.frequency / p.small_frequency;
  for (int i = 0; i < d.n; ++i) {
    const uint32_t id = big.id[i];
    const float reach = Clamp01(big.edge[i] / p.dome);
    const float tilt =
        p.tilt * ((CellRandom(id, 1) - 0.5f) * big.u[i] + (CellRandom(id, 2) - 0.5f) * big.v[i]);
    const float top = Round(1.0f - reach) * (0.6f + 0.8f * CellRandom(id, 3)) + tilt;
    const float pebble = SmoothStep(p.gap, p.gap + 0.06f, big.edge[i]);
    const float grit = ratio * (Round(1.0f - Clamp01(3.0f * small.edge[i])) - 1.0f);
    const float sand = CellRandom(small.id[i], 4);
    const Color& c = p.pebbles[static_cast<int>(3.999f * CellRandom(id, 5))];
    const float gain = (0.65f + 0.6f * CellRandom(id, 6)) * (1.0f + 0.4f * grain[i]);
    const float under = (0.4f + 0.8f * sand) * (1.0f + 0.4f * grain[i]);
    out.height[i] = Mix(grit, top, pebble) + 0.06f * grain[i];
    out.r[i] = Clamp01(Mix(p.ground.r * under, c.r * gain, pebble));
    out.g[i] = Clamp01(Mix(p.ground.g * under, c.g * gain, pebble));
    out.b[i] = Clamp01(Mix(p.ground.b * under, c.b * gain, pebble));
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness + 0.15f * (1.0f - pebble) - p.wet * CellRandom(id, 7) * pebble +
                       0.1f * grain[i];
  }
}

struct Cracks {
  Stone stone;
  Warp warp;
  float frequency, width, bevel, depth, curl, plate_tone;
  uint32_t seed;
};

void CracksRow(Cracks p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  StoneRow(p.stone, d, s, out);
  const RowDomain w = Warped(p.warp, d, s);
  const TilingRows cells = TakeTilingRows(s);
  Voronoi(p.frequency, 0.95f, p.seed, w.x, w.y, d.n, {cells.u, cells.v, cells.edge, cells.id});
  const float soft = EdgeWidth(p.bevel, p.frequency, d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const float width = p.width * (0.4f + 1.2f * Clamp01(0.5f + cells.u[i]));
    const float plate = SmoothStep(width, width + soft, cells.edge[i]);
    const float rim = p.curl * (1.0f - SmoothStep(0.0f, 0.35f, cells.edge[i]));
    const float gain = Mix(0.3f, 1.0f + p.plate_tone * (CellRandom(cells.id[i], 1) - 0.5f), plate);
    out.height[i] = 0.4f * out.height[i] + p.depth * (plate - 1.0f) + rim * plate;
    out.r[i] *= gain;
    out.g[i] *= gain;
    out.b[i] *= gain;
    out.roughness[i] += 0.15f * (1.0f - plate);
  }
}

struct Plaster {
  NoiseOptions strokes, grain, tone;
  Warp warp;
  float level, soft, plateau, roughness, worn;
  Scheme colors;
  float f0;
};

void PlasterRow(Plaster p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* strokes = NoiseRow(p.strokes, w, s);
  const float* grain = NoiseRow(p.grain, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  for (int i = 0; i < d.n; ++i) {
    const float flat = SmoothStep(p.level - p.soft, p.level + p.soft, strokes[i]);
    const float t = Clamp01(0.4f + 0.7f * tone[i]);
    const float gain = 1.0f + 0.12f * grain[i];
    out.height[i] = Mix(strokes[i], flat, p.plateau) + 0.08f * grain[i] * (1.0f - 0.7f * flat);
    out.r[i] =
        gain * Mix(Mix(p.colors.base.r, p.colors.second.r, t), p.colors.third.r, p.worn * flat);
    out.g[i] =
        gain * Mix(Mix(p.colors.base.g, p.colors.second.g, t), p.colors.third.g, p.worn * flat);
    out.b[i] =
        gain * Mix(Mix(p.colors.base.b, p.colors.second.b, t), p.colors.third.b, p.worn * flat);
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness - 0.25f * p.worn * flat + 0.08f * tone[i];
  }
}

Stone StoneParameters(Rng& rng) {
  Stone p;
  const float kind = rng.Unit();
  const NoiseKind relief = kind < 0.5f    ? NoiseKind::kSmooth
                           : kind < 0.75f ? NoiseKind::kBillow
                                          : NoiseKind::kRidged;
  p.relief = DrawNoise(rng, relief, 2.5f, 30.0f, 5);
  if (rng.Chance(0.3f)) p.relief.stretch = rng.LogUniform(0.2f, 5.0f);  // layered rock
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 3.0f, 60.0f, 4);
  p.patches = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 6.0f, 4);
  p.pits = DrawNoise(rng, NoiseKind::kSmooth, 12.0f, 50.0f, 2);
  p.colors = DrawScheme(
      rng,
      [](Rng& r) {
        return r.Chance(0.5f) ? GreyColor(r) : r.Chance(0.7f) ? EarthColor(r) : AnyColor(r);
      },
      0.7f);
  p.pit_level = rng.Chance(0.5f) ? rng.Uniform(0.25f, 0.6f) : 9.0f;
  p.pit_depth = rng.Uniform(0.1f, 0.8f);
  p.tone_by_height = rng.Uniform(-1.0f, 1.0f);
  p.tone_contrast = rng.LogUniform(0.3f, 3.0f);
  p.patch_contrast = rng.Uniform(0.05f, 0.8f);
  p.roughness = AnyRoughness(rng, 0.35f);
  p.roughness_spread = rng.Uniform(0.0f, 0.35f);
  p.f0 = AnyDielectricF0(rng);
  return p;
}

}  // namespace

RowFunction DrawStone(Rng& rng) { return Bind(StoneParameters(rng), StoneRow); }

RowFunction DrawMarble(Rng& rng) {
  Marble p;
  p.warp = DrawWarp(rng, 1.0f, 4.0f, rng.Uniform(0.15f, 0.9f));
  p.warp.noise.octaves = rng.Int(2, 5);
  p.body = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 8.0f, 5);
  p.veins = DrawNoise(rng, NoiseKind::kRidged, 1.0f, 5.0f, 1);
  p.veins.stretch = rng.LogUniform(0.3f, 3.0f);
  p.fine_veins = DrawNoise(rng, NoiseKind::kRidged, 3.0f, 10.0f, 1);
  p.colors.base = rng.Chance(0.6f) ? GreyColor(rng) : AnyColor(rng);
  p.colors.second = Related(rng, p.colors.base, 0.5f);
  p.colors.third = rng.Chance(0.5f) ? AnyColor(rng) : Related(rng, p.colors.base, 1.8f);
  p.vein_width = rng.LogUniform(0.04f, 0.5f);
  p.fine_width = rng.LogUniform(0.03f, 0.15f);
  p.vein_strength = rng.Uniform(0.4f, 1.0f);
  p.fine_strength = rng.Chance(0.6f) ? rng.Uniform(0.1f, 0.8f) : 0.0f;
  p.roughness = AnyRoughness(rng, -0.6f);
  p.vein_roughness = rng.Uniform(-0.1f, 0.3f);
  p.f0 = AnyDielectricF0(rng);
  p.cloudy = rng.LogUniform(0.3f, 2.5f);
  p.dent = rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.5f) : 0.0f;
  return Bind(p, MarbleRow);
}

RowFunction DrawTerrazzo(Rng& rng) {
  Terrazzo p;
  p.binder = rng.Chance(0.6f) ? GreyColor(rng) : AnyColor(rng);
  for (Color& c : p.chips) c = rng.Chance(0.5f) ? Related(rng, p.binder, 1.0f) : AnyColor(rng);
  p.frequency[0] = rng.LogUniform(12.0f, 50.0f);
  p.frequency[1] = rng.LogUniform(4.0f, 16.0f);
  for (int layer = 0; layer < 2; ++layer) {
    p.presence[layer] = rng.Uniform(0.1f, 0.95f);
    p.inset[layer] = rng.Uniform(0.03f, 0.2f);
    p.seed[layer] = rng.Seed();
  }
  p.grain = DrawNoise(rng, NoiseKind::kSmooth, 20.0f, 80.0f, 2);
  p.warp = DrawWarp(rng, 6.0f, 25.0f, rng.Uniform(0.0f, 0.5f));
  p.roughness = AnyRoughness(rng, -0.3f);
  p.chip_gloss = rng.Uniform(-0.1f, 0.3f);
  p.f0 = AnyDielectricF0(rng);
  p.chip_rise = rng.Chance(0.4f) ? rng.Uniform(-0.3f, 0.6f) : 0.0f;
  return Bind(p, TerrazzoRow);
}

RowFunction DrawGravel(Rng& rng) {
  Gravel p;
  p.frequency = rng.LogUniform(5.0f, 40.0f);
  p.small_frequency = p.frequency * rng.Uniform(1.8f, 4.0f);
  p.jitter = rng.Uniform(0.5f, 1.0f);
  p.dome = rng.Uniform(0.15f, 0.6f);
  p.gap = rng.Uniform(-0.02f, 0.12f);
  p.tilt = rng.Uniform(0.0f, 2.0f);
  p.seed = rng.Seed();
  p.small_seed = rng.Seed();
  const Color first =
      rng.Chance(0.8f) ? (rng.Chance(0.5f) ? GreyColor(rng) : EarthColor(rng)) : AnyColor(rng);
  for (Color& c : p.pebbles) c = rng.Chance(0.75f) ? Related(rng, first, 0.8f) : AnyColor(rng);
  p.ground = ScaleColor(Related(rng, first, 0.6f), rng.Uniform(0.2f, 0.9f));
  p.grain = DrawNoise(rng, NoiseKind::kSmooth, 20.0f, 80.0f, 3);
  p.warp = DrawWarp(rng, 4.0f, 30.0f, rng.Uniform(0.0f, 0.5f));
  p.roughness = AnyRoughness(rng, 0.3f);
  p.wet = rng.Chance(0.3f) ? rng.Uniform(0.1f, 0.5f) : rng.Uniform(0.0f, 0.1f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, GravelRow);
}

RowFunction DrawCracks(Rng& rng) {
  Cracks p;
  p.stone = StoneParameters(rng);
  p.warp = DrawWarp(rng, 3.0f, 12.0f, rng.Uniform(0.1f, 0.7f));
  p.frequency = rng.LogUniform(2.5f, 14.0f);
  p.width = rng.LogUniform(0.008f, 0.06f);
  p.bevel = rng.LogUniform(0.01f, 0.15f);
  p.depth = rng.Uniform(0.3f, 1.5f);
  p.curl = rng.Chance(0.4f) ? rng.Uniform(-0.5f, 0.8f) : 0.0f;
  p.plate_tone = rng.Uniform(0.0f, 0.6f);
  p.seed = rng.Seed();
  return Bind(p, CracksRow);
}

RowFunction DrawPlaster(Rng& rng) {
  Plaster p;
  p.strokes =
      DrawNoise(rng, rng.Chance(0.6f) ? NoiseKind::kSmooth : NoiseKind::kRidged, 4.0f, 30.0f, 3);
  p.strokes.stretch = rng.Chance(0.5f) ? rng.LogUniform(0.15f, 6.0f) : 1.0f;
  p.grain = DrawNoise(rng, NoiseKind::kSmooth, 40.0f, 110.0f, 2);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 10.0f, 4);
  p.warp = DrawWarp(rng, 2.0f, 8.0f, rng.Uniform(0.0f, 0.9f));
  p.level = rng.Uniform(-0.2f, 0.4f);
  p.soft = rng.LogUniform(0.04f, 0.5f);
  p.plateau = rng.Unit();
  p.roughness = AnyRoughness(rng, 0.5f);
  p.worn = rng.Chance(0.5f) ? rng.Unit() : 0.0f;
  p.colors = DrawScheme(rng, AnyColor, 0.35f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, PlasterRow);
}

}  // namespace glint::procedural
