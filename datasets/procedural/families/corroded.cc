// Layers that come off or grow over others: rust and patina, peeling paint, spills.
#include "datasets/procedural/families/common.h"
#include "datasets/procedural/families/families.h"

namespace glint::procedural {
namespace {

struct Rust {
  Warp warp;
  NoiseOptions extent, bumps, tone, runs;
  Color metal, rust, rust_dark, halo;
  float level, soft, swelling, pitting, run_strength, halo_width;
  float metal_roughness, rust_roughness, roughness_spread, f0, base_metal;
};

void RustRow(Rust p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* extent = NoiseRow(p.extent, w, s);
  const float* bumps = NoiseRow(p.bumps, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const float* runs = NoiseRow(p.runs, d, s);
  for (int i = 0; i < d.n; ++i) {
    const float field = extent[i] + p.run_strength * runs[i] + 0.12f * bumps[i];
    const float rust = SmoothStep(p.level - p.soft, p.level + p.soft, field);
    const float halo = SmoothStep(p.level - p.soft - p.halo_width, p.level, field) * (1.0f - rust);
    const float deep = Clamp01(0.5f + 0.8f * tone[i] + 0.5f * bumps[i]);
    const float shine = 1.0f + 0.1f * tone[i];
    out.height[i] = rust * (p.swelling + p.pitting * bumps[i]) + 0.03f * (1.0f - rust) * bumps[i];
    out.r[i] = Clamp01(Mix(Mix(p.metal.r * shine, p.halo.r, 0.6f * halo),
                           Mix(p.rust.r, p.rust_dark.r, deep), rust));
    out.g[i] = Clamp01(Mix(Mix(p.metal.g * shine, p.halo.g, 0.6f * halo),
                           Mix(p.rust.g, p.rust_dark.g, deep), rust));
    out.b[i] = Clamp01(Mix(Mix(p.metal.b * shine, p.halo.b, 0.6f * halo),
                           Mix(p.rust.b, p.rust_dark.b, deep), rust));
    out.metal[i] = p.base_metal * (1.0f - rust);
    out.f0[i] = p.f0;
    out.roughness[i] = Mix(p.metal_roughness + p.roughness_spread * tone[i] + 0.2f * halo,
                           p.rust_roughness + 0.15f * bumps[i], rust);
  }
}

struct PeelingPaint {
  Warp warp;
  NoiseOptions extent, paint_bumps, under_bumps, tone;
  Color paint, paint_aged, under, under_second, rim;
  float level, thickness, rim_width, rim_strength, under_relief, paint_relief, under_metal;
  float paint_roughness, under_roughness, f0, crack_frequency, crack_pull;
  uint32_t crack_seed;
};

void PeelingPaintRow(PeelingPaint p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* extent = NoiseRow(p.extent, w, s);
  const float* paint_bumps = NoiseRow(p.paint_bumps, d, s);
  const float* under_bumps = NoiseRow(p.under_bumps, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const TilingRows cells = TakeTilingRows(s);
  Voronoi(p.crack_frequency, 0.95f, p.crack_seed, w.x, w.y, d.n,
          {cells.u, cells.v, cells.edge, cells.id});
  const float soft = std::max(0.02f, 2.0f * p.extent.frequency * d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const float crack = 1.0f - SmoothStep(0.0f, 0.1f, cells.edge[i]);
    const float field = extent[i] - p.level - p.crack_pull * crack +
                        p.crack_pull * 0.5f * (CellRandom(cells.id[i], 1) - 0.5f);
    const float paint = SmoothStep(-soft, soft, field);
    const float rim = p.rim_strength * paint * (1.0f - SmoothStep(soft, soft + p.rim_width, field));
    const float t = Clamp01(0.5f + 0.7f * tone[i]);
    const float q = Clamp01(0.5f + 0.9f * under_bumps[i]);
    out.height[i] = paint * (p.thickness * (1.0f + 0.6f * rim) + p.paint_relief * paint_bumps[i]) +
                    (1.0f - 0.7f * paint) * p.under_relief * under_bumps[i];
    const float r = Mix(Mix(p.paint.r, p.paint_aged.r, t), p.rim.r, rim);
    const float g = Mix(Mix(p.paint.g, p.paint_aged.g, t), p.rim.g, rim);
    const float b = Mix(Mix(p.paint.b, p.paint_aged.b, t), p.rim.b, rim);
    out.r[i] = Mix(Mix(p.under.r, p.under_second.r, q), r, paint);
    out.g[i] = Mix(Mix(p.under.g, p.under_second.g, q), g, paint);
    out.b[i] = Mix(Mix(p.under.b, p.under_second.b, q), b, paint);
    out.metal[i] = p.under_metal * (1.0f - paint);
    out.f0[i] = p.f0;
    out.roughness[i] =
        Mix(p.under_roughness + 0.15f * under_bumps[i], p.paint_roughness + 0.1f * tone[i], paint);
  }
}

// Puddles, drips, splashes and fingerprints over a plain ground.
struct Stains {
  Warp warp;
  NoiseOptions ground, tone, spill;
  float drop_frequency, drop_size, drop_presence, level, soft, ring;
  uint32_t seed;
  Color color, second, stain;
  float strength, ground_relief, film, roughness, stain_roughness, f0, metal;
};

void StainsRow(Stains p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* ground = NoiseRow(p.ground, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const float* spill = NoiseRow(p.spill, w, s);
  const TilingRows cells = TakeTilingRows(s);
  Voronoi(p.drop_frequency, 0.9f, p.seed, w.x, w.y, d.n, {cells.u, cells.v, cells.edge, cells.id});
  for (int i = 0; i < d.n; ++i) {
    const float reach = std::sqrt(cells.u[i] * cells.u[i] + cells.v[i] * cells.v[i]);
    const float there = CellRandom(cells.id[i], 1) < p.drop_presence ? 1.0f : 0.0f;
    const float drop = there * (p.drop_size * (0.3f + CellRandom(cells.id[i], 2)) - reach);
    const float field = std::max(spill[i] - p.level, drop);
    const float wet = SmoothStep(-p.soft, p.soft, field);
    const float border = p.ring * wet * (1.0f - SmoothStep(p.soft, p.soft + 0.12f, field));
    const float cover = Clamp01(p.strength * wet + border);
    const float t = Clamp01(0.5f + 0.8f * tone[i]);
    out.height[i] = (1.0f - p.film * wet) * p.ground_relief * ground[i] + 0.3f * p.film * wet;
    out.r[i] = Mix(Mix(p.color.r, p.second.r, t), p.stain.r, cover);
    out.g[i] = Mix(Mix(p.color.g, p.second.g, t), p.stain.g, cover);
    out.b[i] = Mix(Mix(p.color.b, p.second.b, t), p.stain.b, cover);
    out.metal[i] = p.metal * (1.0f - cover);
    out.f0[i] = p.f0;
    out.roughness[i] = Mix(p.roughness + 0.15f * ground[i], p.stain_roughness, wet);
  }
}

}  // namespace

RowFunction DrawRust(Rng& rng) {
  Rust p;
  p.warp = DrawWarp(rng, 2.0f, 10.0f, rng.Uniform(0.0f, 0.6f));
  p.extent = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 10.0f, 5);
  p.bumps =
      DrawNoise(rng, rng.Chance(0.5f) ? NoiseKind::kSmooth : NoiseKind::kBillow, 12.0f, 60.0f, 4);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 2.0f, 20.0f, 4);
  p.runs = DrawNoise(rng, NoiseKind::kSmooth, 6.0f, 20.0f, 3);
  p.runs.stretch = rng.LogUniform(0.05f, 0.3f);
  p.base_metal = rng.Chance(0.85f) ? 1.0f : 0.0f;
  p.metal = p.base_metal > 0.0f ? MetalColor(rng) : AnyColor(rng);
  p.rust = RustColor(rng);
  if (rng.Chance(0.2f))
    p.rust = FromHsv(rng.Uniform(0.35f, 0.5f), rng.Uniform(0.3f, 0.8f),
                     rng.Uniform(0.1f, 0.5f));  // verdigris
  if (rng.Chance(0.15f)) p.rust = AnyColor(rng);
  p.rust_dark = ScaleColor(Related(rng, p.rust, 0.4f), rng.LogUniform(0.2f, 0.9f));
  p.halo = Related(rng, p.rust, 0.5f);
  p.level = rng.Uniform(-0.35f, 0.35f);
  p.soft = rng.LogUniform(0.02f, 0.3f);
  p.swelling = rng.Uniform(-0.4f, 0.6f);
  p.pitting = rng.Uniform(0.2f, 1.0f);
  p.run_strength = rng.Chance(0.5f) ? rng.Uniform(0.0f, 0.8f) : 0.0f;
  p.halo_width = rng.Uniform(0.02f, 0.3f);
  p.metal_roughness = AnyRoughness(rng, -0.4f);
  p.rust_roughness = rng.Uniform(0.55f, 0.98f);
  p.roughness_spread = rng.Uniform(0.0f, 0.3f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, RustRow);
}

RowFunction DrawPeelingPaint(Rng& rng) {
  PeelingPaint p;
  p.warp = DrawWarp(rng, 2.0f, 10.0f, rng.Uniform(0.0f, 0.5f));
  p.extent = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 9.0f, 5);
  p.paint_bumps = DrawNoise(rng, NoiseKind::kSmooth, 8.0f, 60.0f, 2);
  p.under_bumps =
      DrawNoise(rng, rng.Chance(0.5f) ? NoiseKind::kSmooth : NoiseKind::kRidged, 6.0f, 40.0f, 4);
  if (rng.Chance(0.4f)) p.under_bumps.stretch = rng.LogUniform(5.0f, 12.0f);  // wood below
  if (p.under_bumps.stretch > 1.0f) p.under_bumps.frequency *= 0.3f;
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 10.0f, 4);
  p.paint = AnyColor(rng);
  p.paint_aged = Related(rng, p.paint, 0.4f);
  p.under_metal = rng.Chance(0.35f) ? 1.0f : 0.0f;
  p.under = p.under_metal > 0.0f ? MetalColor(rng)
            : rng.Chance(0.6f)   ? EarthColor(rng)
                                 : GreyColor(rng);
  p.under_second = Related(rng, p.under, p.under_metal > 0.0f ? 0.1f : 0.6f);
  p.rim = Related(rng, p.paint, 0.8f);
  p.level = rng.Uniform(-0.35f, 0.2f);
  p.thickness = rng.Uniform(0.1f, 0.8f);
  p.rim_width = rng.Uniform(0.02f, 0.12f);
  p.rim_strength = rng.Uniform(0.0f, 1.0f);
  p.under_relief = rng.Uniform(0.1f, 0.6f);
  p.paint_relief = rng.Uniform(0.0f, 0.2f);
  p.paint_roughness = AnyRoughness(rng, -0.3f);
  p.under_roughness = AnyRoughness(rng, 0.3f);
  p.f0 = AnyDielectricF0(rng);
  p.crack_frequency = rng.LogUniform(3.0f, 16.0f);
  p.crack_pull = rng.Chance(0.5f) ? rng.Uniform(0.0f, 0.6f) : 0.0f;
  p.crack_seed = rng.Seed();
  return Bind(p, PeelingPaintRow);
}

RowFunction DrawStains(Rng& rng) {
  Stains p;
  p.warp = DrawWarp(rng, 3.0f, 12.0f, rng.Uniform(0.0f, 0.4f));
  p.ground = DrawNoise(rng, NoiseKind::kSmooth, 10.0f, 80.0f, 3);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 10.0f, 4);
  p.spill = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 5.0f, 3);
  p.drop_frequency = rng.LogUniform(2.0f, 20.0f);
  p.drop_size = rng.Uniform(0.1f, 0.5f);
  p.drop_presence = rng.Unit();
  p.level = rng.Uniform(0.0f, 0.6f);
  p.soft = rng.LogUniform(0.02f, 0.3f);
  p.ring = rng.Chance(0.5f) ? rng.Uniform(0.0f, 0.8f) : 0.0f;
  p.seed = rng.Seed();
  p.metal = rng.Chance(0.3f) ? 1.0f : 0.0f;
  p.color = p.metal > 0.0f ? MetalColor(rng) : AnyColor(rng);
  p.second = Related(rng, p.color, rng.Uniform(0.0f, 0.4f));
  p.stain = rng.Chance(0.6f) ? ScaleColor(Related(rng, p.color, 0.5f), rng.LogUniform(0.2f, 0.8f))
                             : AnyColor(rng);
  p.strength = rng.Uniform(0.0f, 1.0f);
  p.ground_relief = rng.Uniform(0.1f, 1.0f);
  p.film = rng.Chance(0.5f) ? rng.Unit() : 0.0f;
  p.roughness = AnyRoughness(rng, 0.2f);
  p.stain_roughness = AnyRoughness(rng, -0.4f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, StainsRow);
}

}  // namespace glint::procedural
