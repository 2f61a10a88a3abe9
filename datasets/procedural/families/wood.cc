// Sawn wood, boards of it, and bark.
#include "datasets/procedural/families/common.h"
#include "datasets/procedural/families/families.h"

namespace glint::procedural {
namespace {

struct Wood {
  Warp warp;
  NoiseOptions flow, pores, tone;
  Color early, late;
  float rings, flow_rings, late_start, contrast, ring_relief;
  float knot_frequency, knot_presence;
  uint32_t knot_seed;
  float pore_level, pore_depth, pore_dark, tone_strength;
  float roughness, late_gloss, f0;
};

void WoodRow(Wood p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* flow = NoiseRow(p.flow, w, s);
  const float* pores = NoiseRow(p.pores, w, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const TilingRows knots = TakeTilingRows(s);
  const RowDomain k = Stretched(w, 0.4f, 1.0f, s);
  if (p.knot_presence > 0.0f) {
    Voronoi(p.knot_frequency, 0.9f, p.knot_seed, k.x, k.y, d.n,
            {knots.u, knots.v, knots.edge, knots.id});
  } else {
    SetAll(knots.u, d.n, 9.0f);
    SetAll(knots.v, d.n, 9.0f);
    std::fill(knots.id, knots.id + d.n, 0u);
  }
  // Rings finer than texels melt into their mean.
  const float clear = Clamp01(2.0f - 3.5f * p.rings * d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const float from_knot = std::sqrt(knots.u[i] * knots.u[i] + knots.v[i] * knots.v[i]);
    const float present = CellRandom(knots.id[i], 1) < p.knot_presence ? 1.0f : 0.0f;
    const float knot = present * SmoothStep(0.0f, 1.0f, 1.0f - 3.0f * from_knot);
    const float swirl = present * 2.5f / (1.0f + 40.0f * from_knot * from_knot);
    const float t = Fract(w.y[i] * p.rings + p.flow_rings * flow[i] + swirl * p.rings * 0.08f);
    const float saw = t < 0.92f ? t / 0.92f : (1.0f - t) / 0.08f;
    const float late = Mix(0.4f, SmoothStep(p.late_start, 1.0f, saw), clear);
    const float pore = SmoothStep(p.pore_level, p.pore_level + 0.15f, pores[i]);
    const float grain = Clamp01(p.contrast * late + 0.25f * pores[i] + 0.8f * knot);
    const float gain =
        (1.0f + p.tone_strength * tone[i]) * (1.0f - p.pore_dark * pore) * (1.0f - 0.5f * knot);
    out.height[i] = p.ring_relief * late - p.pore_depth * pore + 0.05f * pores[i];
    out.r[i] = Clamp01(gain * Mix(p.early.r, p.late.r, grain));
    out.g[i] = Clamp01(gain * Mix(p.early.g, p.late.g, grain));
    out.b[i] = Clamp01(gain * Mix(p.early.b, p.late.b, grain));
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness - p.late_gloss * late + 0.15f * pore + 0.05f * tone[i];
  }
}

struct Planks {
  Wood wood;
  TilingOptions tiling;
  Warp warp;
  float gap, bevel, depth, tone, rise, gloss, cup;
};

void PlanksRow(Planks p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const TilingRows cells = TakeTilingRows(s);
  Tile(p.tiling, w.x, w.y, d.n, cells);
  // Each board is cut from another place of the tree.
  float* x = s.Row();
  float* y = s.Row();
  const float scale = 1.0f / p.tiling.frequency;
  for (int i = 0; i < d.n; ++i) {
    x[i] = cells.u[i] * scale + 40.0f * CellRandom(cells.id[i], 1);
    y[i] = cells.v[i] * scale + 40.0f * CellRandom(cells.id[i], 2);
  }
  WoodRow(p.wood, {x, y, d.n, d.pixel}, s, out);
  const float sharp = EdgeWidth(0.01f, p.tiling.frequency, d.pixel);
  const float bevel = EdgeWidth(p.bevel, p.tiling.frequency, d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const uint32_t id = cells.id[i];
    const float edge = cells.edge[i] - p.gap;
    const float board = SmoothStep(-sharp, sharp, edge);
    const float raised = SmoothStep(-0.5f * bevel, bevel, edge);
    const float gain = (1.0f + p.tone * (CellRandom(id, 3) - 0.5f)) * Mix(0.15f, 1.0f, board);
    const float warm = 1.0f + 0.25f * p.tone * (CellRandom(id, 4) - 0.5f);
    const float cup = p.cup * cells.v[i] * cells.v[i] * (CellRandom(id, 5) - 0.3f);
    out.height[i] = Mix(-p.depth, out.height[i] + p.rise * CellRandom(id, 6) + cup, raised);
    out.r[i] = Clamp01(out.r[i] * gain * warm);
    out.g[i] = Clamp01(out.g[i] * gain);
    out.b[i] = Clamp01(out.b[i] * gain / warm);
    out.roughness[i] = Mix(0.9f, out.roughness[i] + p.gloss * (CellRandom(id, 7) - 0.5f), board);
  }
}

struct Bark {
  Warp warp;
  NoiseOptions furrows, flakes, tone;
  float frequency, stretch, plate_width, plate_depth;
  uint32_t seed;
  Scheme colors;
  Color lichen;
  float lichen_level, roughness, f0;
};

void BarkRow(Bark p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* furrows = NoiseRow(p.furrows, w, s);
  const float* flakes = NoiseRow(p.flakes, w, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const TilingRows cells = TakeTilingRows(s);
  const RowDomain k = Stretched(w, 1.0f, p.stretch, s);
  Voronoi(p.frequency, 0.95f, p.seed, k.x, k.y, d.n, {cells.u, cells.v, cells.edge, cells.id});
  for (int i = 0; i < d.n; ++i) {
    const float plate = SmoothStep(0.0f, p.plate_width, cells.edge[i]);
    const float h = p.plate_depth * plate + (1.0f - p.plate_depth) * furrows[i] + 0.25f * flakes[i];
    const float t = Clamp01(1.2f * h - 0.3f + 0.4f * flakes[i]);
    const float q = Clamp01(0.4f + 0.7f * tone[i]);
    const float lichen =
        SmoothStep(p.lichen_level, p.lichen_level + 0.15f, tone[i] + 0.4f * flakes[i]);
    const float shade = 0.35f + 0.65f * t;
    out.height[i] = h;
    out.r[i] = Mix(shade * Mix(p.colors.base.r, p.colors.second.r, q), p.lichen.r, 0.8f * lichen);
    out.g[i] = Mix(shade * Mix(p.colors.base.g, p.colors.second.g, q), p.lichen.g, 0.8f * lichen);
    out.b[i] = Mix(shade * Mix(p.colors.base.b, p.colors.second.b, q), p.lichen.b, 0.8f * lichen);
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness + 0.2f * (0.5f - t) + 0.1f * lichen;
  }
}

Wood WoodParameters(Rng& rng) {
  Wood p;
  p.warp = DrawWarp(rng, 0.8f, 3.0f, rng.Uniform(0.02f, 0.25f));
  p.flow = DrawNoise(rng, NoiseKind::kSmooth, 0.4f, 1.4f, 2);
  p.flow.stretch = rng.Uniform(2.0f, 7.0f);
  p.pores = DrawNoise(rng, NoiseKind::kSmooth, 3.0f, 9.0f, 2);
  p.pores.stretch = rng.LogUniform(8.0f, 20.0f);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 4.0f, 4);
  p.tone.stretch = rng.Uniform(1.0f, 8.0f);
  p.early = WoodColor(rng);
  p.late = ScaleColor(Related(rng, p.early, 0.3f), rng.LogUniform(0.2f, 0.8f));
  p.rings = rng.LogUniform(3.0f, 40.0f);
  p.flow_rings = p.rings * rng.LogUniform(0.03f, 0.5f);
  p.late_start = rng.Uniform(0.0f, 0.7f);
  p.contrast = rng.Uniform(0.2f, 1.0f);
  p.ring_relief = rng.Uniform(-0.5f, 0.8f);
  p.knot_frequency = rng.LogUniform(1.5f, 5.0f);
  p.knot_presence = rng.Chance(0.35f) ? rng.Uniform(0.1f, 0.6f) : 0.0f;
  p.knot_seed = rng.Seed();
  p.pore_level = rng.Uniform(0.15f, 0.5f);
  p.pore_depth = rng.Uniform(0.0f, 0.6f);
  p.pore_dark = rng.Uniform(0.0f, 0.6f);
  p.tone_strength = rng.Uniform(0.1f, 0.7f);
  p.roughness = AnyRoughness(rng, rng.Chance(0.5f) ? -0.4f : 0.3f);  // varnished or raw
  p.late_gloss = rng.Uniform(-0.1f, 0.2f);
  p.f0 = AnyDielectricF0(rng);
  return p;
}

}  // namespace

RowFunction DrawWood(Rng& rng) { return Bind(WoodParameters(rng), WoodRow); }

RowFunction DrawPlanks(Rng& rng) {
  Planks p;
  p.wood = WoodParameters(rng);
  static constexpr Tiling kLayouts[] = {Tiling::kRandomBond, Tiling::kRandomBond,
                                        Tiling::kRunningBond, Tiling::kHerringbone,
                                        Tiling::kBasket};
  p.tiling.tiling = kLayouts[rng.Int(0, 4)];
  const bool parquet =
      p.tiling.tiling == Tiling::kHerringbone || p.tiling.tiling == Tiling::kBasket;
  p.tiling.aspect = parquet ? rng.Int(3, 6) : rng.Int(4, 14);
  p.tiling.frequency = rng.LogUniform(3.0f, 14.0f);
  p.tiling.seed = rng.Seed();
  p.warp = DrawWarp(rng, 1.5f, 6.0f, rng.Chance(0.3f) ? rng.Uniform(0.0f, 0.03f) : 0.0f);
  p.gap = rng.LogUniform(0.004f, 0.05f);
  p.bevel = rng.LogUniform(0.01f, 0.12f);
  p.depth = rng.Uniform(0.2f, 2.0f);
  p.tone = rng.Uniform(0.0f, 0.9f);
  p.rise = rng.Uniform(0.0f, 0.5f);
  p.gloss = rng.Uniform(0.0f, 0.25f);
  p.cup = rng.Uniform(0.0f, 1.5f);
  return Bind(p, PlanksRow);
}

RowFunction DrawBark(Rng& rng) {
  Bark p;
  p.warp = DrawWarp(rng, 2.0f, 6.0f, rng.Uniform(0.1f, 0.6f));
  p.furrows =
      DrawNoise(rng, rng.Chance(0.6f) ? NoiseKind::kRidged : NoiseKind::kBillow, 4.0f, 14.0f, 4);
  p.furrows.stretch = rng.LogUniform(0.12f, 0.8f);
  p.flakes = DrawNoise(rng, NoiseKind::kSmooth, 12.0f, 40.0f, 3);
  p.flakes.stretch = rng.LogUniform(0.3f, 1.5f);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 8.0f, 3);
  p.frequency = rng.LogUniform(4.0f, 14.0f);
  p.stretch = rng.LogUniform(0.2f, 0.9f);
  p.plate_width = rng.Uniform(0.08f, 0.4f);
  p.plate_depth = rng.Unit();
  p.seed = rng.Seed();
  p.colors = DrawScheme(
      rng, [](Rng& r) { return r.Chance(0.6f) ? EarthColor(r) : GreyColor(r); }, 0.7f);
  p.lichen = FromHsv(rng.Uniform(0.08f, 0.35f), rng.Uniform(0.2f, 0.7f), rng.Uniform(0.1f, 0.5f));
  p.lichen_level = rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.4f) : 9.0f;
  p.roughness = AnyRoughness(rng, 0.6f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, BarkRow);
}

}  // namespace glint::procedural
