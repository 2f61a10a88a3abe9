// Walls and floors of repeated pieces.
#include "datasets/procedural/families/common.h"
#include "datasets/procedural/families/families.h"

namespace glint::procedural {
namespace {

struct Masonry {
  TilingOptions tiling;
  Warp warp;
  NoiseOptions surface, tone;
  Color pieces[4];
  Color joint;
  int kinds;                 // of pieces, 1 to 4
  bool checkered;            // kinds alternate instead of being drawn
  float joint_width, bevel;  // in short sides
  float ragged;              // wander of the joint's border
  float joint_depth, surface_relief, rise, tilt, dome;
  float piece_tone, surface_tone, rim_dark;
  float roughness, piece_roughness, joint_roughness, f0;
};

void MasonryRow(Masonry p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* surface = NoiseRow(p.surface, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const RowDomain w = Warped(p.warp, d, s);
  const TilingRows cells = TakeTilingRows(s);
  Tile(p.tiling, w.x, w.y, d.n, cells);
  const float bevel = EdgeWidth(p.bevel, p.tiling.frequency, d.pixel);
  const float sharp = EdgeWidth(0.03f, p.tiling.frequency, d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const uint32_t id = cells.id[i];
    const float edge = cells.edge[i] - p.joint_width * (1.0f + p.ragged * surface[i]);
    const float piece = SmoothStep(-0.5f * sharp, 0.5f * sharp, edge);
    const float raised = SmoothStep(-0.3f * bevel, bevel, edge);
    const float drawn = static_cast<float>(p.kinds) * CellRandom(id, 1);
    const int kind = std::min(p.checkered ? static_cast<int>(id & 1u) : static_cast<int>(drawn), 3);
    const float gain = (1.0f + p.piece_tone * (CellRandom(id, 2) - 0.5f)) *
                       (1.0f + p.surface_tone * tone[i]) *
                       (1.0f - p.rim_dark * (1.0f - SmoothStep(0.0f, 3.0f * bevel, edge)));
    const float joint_gain = 1.0f + 0.5f * surface[i];
    const float slope = p.tilt * ((CellRandom(id, 3) - 0.5f) * cells.u[i] +
                                  (CellRandom(id, 4) - 0.5f) * cells.v[i]);
    const float top = p.rise * (CellRandom(id, 5) - 0.5f) + slope + p.surface_relief * surface[i] +
                      p.dome * Round(1.0f - Clamp01(2.0f * edge));
    const Color& c = p.pieces[kind];
    out.height[i] = Mix(-p.joint_depth + 0.1f * surface[i], top, raised);
    out.r[i] = Clamp01(Mix(p.joint.r * joint_gain, c.r * gain, piece));
    out.g[i] = Clamp01(Mix(p.joint.g * joint_gain, c.g * gain, piece));
    out.b[i] = Clamp01(Mix(p.joint.b * joint_gain, c.b * gain, piece));
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    const float own =
        p.roughness + p.piece_roughness * (CellRandom(id, 6) - 0.5f) + 0.12f * tone[i];
    out.roughness[i] = Mix(p.joint_roughness, own, piece);
  }
}

// What bricks, tiles and paving share; the callers set materials and shapes.
Masonry Base(Rng& rng) {
  Masonry p;
  p.tiling.seed = rng.Seed();
  p.tiling.aspect = 1;
  p.kinds = rng.Int(1, 4);
  p.checkered = false;
  p.surface =
      DrawNoise(rng, rng.Chance(0.7f) ? NoiseKind::kSmooth : NoiseKind::kBillow, 8.0f, 60.0f, 4);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 3.0f, 40.0f, 4);
  p.bevel = rng.LogUniform(0.02f, 0.2f);
  p.joint_width = rng.LogUniform(0.01f, 0.08f);
  p.joint_depth = rng.Uniform(0.05f, 0.5f);
  p.rise = rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.15f) : 0.0f;
  p.tilt = rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.3f) : 0.0f;
  p.dome = rng.Chance(0.25f) ? rng.Uniform(0.0f, 0.4f) : 0.0f;
  p.rim_dark = rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.5f) : 0.0f;
  p.joint_roughness = rng.Uniform(0.55f, 1.0f);
  p.f0 = AnyDielectricF0(rng);
  return p;
}

template <typename Draw>
void PaintPieces(Rng& rng, Masonry& p, Draw draw, float spread, float stranger) {
  p.pieces[0] = draw(rng);
  for (int k = 1; k < 4; ++k) {
    p.pieces[k] = rng.Chance(stranger) ? draw(rng) : Related(rng, p.pieces[0], spread);
  }
}

}  // namespace

RowFunction DrawBricks(Rng& rng) {
  Masonry p = Base(rng);
  static constexpr Tiling kBonds[] = {Tiling::kRunningBond, Tiling::kRunningBond,
                                      Tiling::kThirdBond,   Tiling::kHerringbone,
                                      Tiling::kBasket,      Tiling::kGrid};
  p.tiling.tiling = kBonds[rng.Int(0, 5)];
  p.tiling.aspect = rng.Int(2, p.tiling.tiling == Tiling::kHerringbone ? 3 : 4);
  p.tiling.frequency = rng.LogUniform(5.0f, 22.0f);
  p.warp = DrawWarp(rng, 4.0f, 14.0f, rng.Chance(0.6f) ? rng.Uniform(0.0f, 0.12f) : 0.0f);
  p.ragged = rng.Uniform(0.0f, 2.0f);
  p.surface_relief = rng.Uniform(0.02f, 0.25f);
  PaintPieces(
      rng, p, [](Rng& r) { return r.Chance(0.75f) ? EarthColor(r) : AnyColor(r); }, 0.6f, 0.15f);
  p.joint = rng.Chance(0.8f) ? GreyColor(rng) : AnyColor(rng);
  p.piece_tone = rng.Uniform(0.0f, 0.8f);
  p.surface_tone = rng.Uniform(0.1f, 0.7f);
  p.roughness = AnyRoughness(rng, 0.4f);
  p.piece_roughness = rng.Uniform(0.0f, 0.3f);
  return Bind(p, MasonryRow);
}

RowFunction DrawTiles(Rng& rng) {
  Masonry p = Base(rng);
  static constexpr Tiling kForms[] = {Tiling::kGrid,    Tiling::kGrid,        Tiling::kHexagon,
                                      Tiling::kHexagon, Tiling::kRunningBond, Tiling::kBasket};
  p.tiling.tiling = kForms[rng.Int(0, 5)];
  p.tiling.aspect = p.tiling.tiling == Tiling::kBasket ? rng.Int(2, 4) : rng.Int(1, 3);
  if (rng.Chance(0.5f) && p.tiling.tiling == Tiling::kGrid) p.tiling.aspect = 1;
  p.tiling.frequency = rng.LogUniform(3.0f, 24.0f);
  p.warp.amount = 0.0f;
  p.checkered = rng.Chance(0.2f);
  p.ragged = rng.Uniform(0.0f, 0.3f);
  p.surface_relief = rng.Chance(0.5f) ? rng.Uniform(0.0f, 0.04f) : 0.0f;
  p.dome = rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.4f) : 0.0f;
  PaintPieces(rng, p, AnyColor, 0.5f, p.checkered ? 0.8f : 0.3f);
  p.joint = rng.Chance(0.7f) ? GreyColor(rng) : AnyColor(rng);
  p.piece_tone = rng.Chance(0.6f) ? rng.Uniform(0.0f, 0.5f) : 0.0f;
  p.surface_tone = rng.Chance(0.6f) ? rng.Uniform(0.0f, 0.5f) : 0.0f;
  p.roughness = AnyRoughness(rng, -0.7f);
  p.piece_roughness = rng.Chance(0.5f) ? rng.Uniform(0.0f, 0.3f) : 0.0f;
  return Bind(p, MasonryRow);
}

RowFunction DrawPaving(Rng& rng) {
  Masonry p = Base(rng);
  static constexpr Tiling kForms[] = {Tiling::kVoronoi, Tiling::kVoronoi, Tiling::kGrid,
                                      Tiling::kRandomBond, Tiling::kHexagon};
  p.tiling.tiling = kForms[rng.Int(0, 4)];
  p.tiling.aspect = rng.Int(1, 2);
  p.tiling.frequency = rng.LogUniform(3.0f, 14.0f);
  p.tiling.jitter = rng.Uniform(0.4f, 0.95f);
  p.warp = DrawWarp(rng, 3.0f, 12.0f, rng.Uniform(0.02f, 0.35f));
  p.joint_width = rng.LogUniform(0.015f, 0.12f);
  p.bevel = rng.LogUniform(0.05f, 0.35f);
  p.ragged = rng.Uniform(0.0f, 1.5f);
  p.surface_relief = rng.Uniform(0.05f, 0.4f);
  p.dome = rng.Chance(0.5f) ? rng.Uniform(0.1f, 0.6f) : 0.0f;
  PaintPieces(
      rng, p, [](Rng& r) { return r.Chance(0.5f) ? GreyColor(r) : EarthColor(r); }, 0.6f, 0.2f);
  p.joint = ScaleColor(EarthColor(rng), rng.Uniform(0.3f, 1.2f));
  if (rng.Chance(0.15f)) p.joint = FromHsv(rng.Uniform(0.18f, 0.3f), 0.7f, 0.1f);  // moss
  p.piece_tone = rng.Uniform(0.0f, 0.7f);
  p.surface_tone = rng.Uniform(0.2f, 0.9f);
  p.roughness = AnyRoughness(rng, 0.3f);
  p.piece_roughness = rng.Uniform(0.0f, 0.3f);
  return Bind(p, MasonryRow);
}

}  // namespace glint::procedural
