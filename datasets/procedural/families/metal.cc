// Bare and painted metals, plastics and other sheet goods.
#include "datasets/procedural/families/common.h"
#include "datasets/procedural/families/families.h"

namespace glint::procedural {
namespace {

struct Brushed {
  Warp warp;
  NoiseOptions strokes, bands, tone;
  bool circular;
  Color color, tint;
  float relief, stroke_roughness, band_roughness, tone_roughness, stroke_tone, roughness, metal, f0;
};

void BrushedRow(Brushed p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  RowDomain w = Warped(p.warp, d, s);
  if (p.circular) {  // turned on a lathe: strokes run round a centre near the picture
    float* along = s.Row();
    float* radius = s.Row();
    for (int i = 0; i < d.n; ++i) {
      const float x = Fract(w.x[i] * 0.5f) * 2.0f - 1.0f, y = Fract(w.y[i] * 0.5f) * 2.0f - 1.0f;
      radius[i] = std::sqrt(x * x + y * y);
      along[i] = 0.3f * std::atan2(y, x + 1e-6f);
    }
    w = {along, radius, d.n, d.pixel};
  }
  const float* strokes = NoiseRow(p.strokes, w, s);
  const float* bands = NoiseRow(p.bands, w, s);
  const float* tone = NoiseRow(p.tone, d, s);
  for (int i = 0; i < d.n; ++i) {
    const float t = Clamp01(0.5f + 0.6f * tone[i]);
    const float gain = 1.0f + p.stroke_tone * (strokes[i] + bands[i]);
    out.height[i] = p.relief * strokes[i] + 0.3f * bands[i];
    out.r[i] = Clamp01(gain * Mix(p.color.r, p.tint.r, t));
    out.g[i] = Clamp01(gain * Mix(p.color.g, p.tint.g, t));
    out.b[i] = Clamp01(gain * Mix(p.color.b, p.tint.b, t));
    out.metal[i] = p.metal;
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness + p.stroke_roughness * strokes[i] + p.band_roughness * bands[i] +
                       p.tone_roughness * tone[i];
  }
}

struct Scratched {
  static constexpr int kLayers = 6;
  StreakOptions layers[kLayers];
  NoiseOptions tone, dents, fine;
  Color color, scratch_color;
  float metal, scratch_metal, depth, color_change, scratch_roughness;
  float roughness, tone_roughness, tone_strength, dent_depth, f0;
};

void ScratchedRow(Scratched p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* tone = NoiseRow(p.tone, d, s);
  const float* dents = NoiseRow(p.dents, d, s);
  const float* fine = NoiseRow(p.fine, d, s);
  float* profile = s.Row();
  float* cut = s.Row();
  uint32_t* id = s.Ids();
  SetAll(cut, d.n, 0.0f);
  for (const StreakOptions& layer : p.layers) {
    Streaks(layer, d.x, d.y, d.n, d.pixel, profile, id);
    for (int i = 0; i < d.n; ++i) {
      cut[i] = std::max(cut[i], profile[i] * (0.3f + 0.7f * CellRandom(id[i], 1)));
    }
  }
  for (int i = 0; i < d.n; ++i) {
    const float scratch = Clamp01(cut[i]);
    const float gain = 1.0f + p.tone_strength * tone[i] + 0.06f * fine[i];
    const float bare = p.color_change * scratch;
    out.height[i] = -p.depth * scratch + p.dent_depth * dents[i] + 0.02f * fine[i];
    out.r[i] = Clamp01(Mix(gain * p.color.r, p.scratch_color.r, bare));
    out.g[i] = Clamp01(Mix(gain * p.color.g, p.scratch_color.g, bare));
    out.b[i] = Clamp01(Mix(gain * p.color.b, p.scratch_color.b, bare));
    out.metal[i] = Mix(p.metal, p.scratch_metal, bare);
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness + p.scratch_roughness * scratch + p.tone_roughness * tone[i];
  }
}

struct Flakes {
  Warp warp;
  NoiseOptions tone;
  float frequency, second_frequency, tilt, flatness;
  uint32_t seed, second_seed;
  Color colors[4];
  float share, sparkle, metal, ground_metal, tone_strength, roughness, roughness_spread, f0;
  Color ground;
};

void FlakesRow(Flakes p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const TilingRows a = TakeTilingRows(s), b = TakeTilingRows(s);
  Voronoi(p.frequency, 1.0f, p.seed, w.x, w.y, d.n, {a.u, a.v, a.edge, a.id});
  Voronoi(p.second_frequency, 1.0f, p.second_seed, w.x, w.y, d.n, {b.u, b.v, b.edge, b.id});
  for (int i = 0; i < d.n; ++i) {
    const bool upper = CellRandom(b.id[i], 1) < 0.4f;  // flakes overlap in two layers
    const uint32_t id = upper ? b.id[i] : a.id[i];
    const float u = upper ? b.u[i] : a.u[i], v = upper ? b.v[i] : a.v[i];
    const float lean = CellRandom(id, 2) * CellRandom(id, 2);
    const float facet =
        p.tilt * lean * (SinTurn(CellRandom(id, 3)) * u + CosTurn(CellRandom(id, 3)) * v);
    const float flake = CellRandom(id, 4) < p.share ? 1.0f : 0.0f;
    const Color& c = p.colors[static_cast<int>(3.999f * CellRandom(id, 5))];
    const float gain =
        (1.0f + p.sparkle * (CellRandom(id, 6) - 0.5f)) * (1.0f + p.tone_strength * tone[i]);
    out.height[i] = facet * flake + (1.0f - p.flatness) * 0.1f * tone[i];
    out.r[i] = Clamp01(gain * Mix(p.ground.r, c.r, flake));
    out.g[i] = Clamp01(gain * Mix(p.ground.g, c.g, flake));
    out.b[i] = Clamp01(gain * Mix(p.ground.b, c.b, flake));
    out.metal[i] = Mix(p.ground_metal, p.metal, flake);
    out.f0[i] = p.f0;
    out.roughness[i] =
        p.roughness + p.roughness_spread * (CellRandom(id, 7) - 0.5f) * flake + 0.05f * tone[i];
  }
}

struct Plates {
  NoiseOptions tone, dents, streaks;
  TilingOptions tiling;
  bool tread;
  Color color, groove;
  float joint, bevel, depth, rivet_radius, rivet_inset, rivet_height, plate_tone, plate_roughness,
      tilt;
  float tread_size, metal, roughness, tone_roughness, dirt, f0;
};

// Lens-shaped bump of a tread plate, alternating in direction from cell to cell.
inline float TreadBump(float u, float v, bool turned, float size) {
  const float along = 0.7071f * (turned ? u + v : u - v),
              across = 0.7071f * (turned ? v - u : u + v);
  const float q = 1.0f - along * along / (size * size);
  const float half = 0.28f * size * std::max(q, 0.0f);
  return q > 0.0f ? Round(std::min(std::fabs(across) / std::max(half, 1e-4f), 1.0f)) * std::sqrt(q)
                  : 0.0f;
}

void PlatesRow(Plates p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* tone = NoiseRow(p.tone, d, s);
  const float* dents = NoiseRow(p.dents, d, s);
  const float* streaks = NoiseRow(p.streaks, d, s);
  const TilingRows cells = TakeTilingRows(s);
  Tile(p.tiling, d.x, d.y, d.n, cells);
  const float half_u = 0.5f * static_cast<float>(p.tiling.aspect);
  const float bevel = EdgeWidth(p.bevel, p.tiling.frequency, d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const uint32_t id = cells.id[i];
    const float u = cells.u[i], v = cells.v[i];
    float relief = 0.0f, joint = 0.0f, own = 0.0f, lean = 0.0f;
    if (p.tread) {
      relief = TreadBump(u, v, (id & 1u) != 0u, p.tread_size);
    } else {
      const float raised = SmoothStep(p.joint, p.joint + bevel, cells.edge[i]);
      const float ru = half_u - p.rivet_inset - std::fabs(u),
                  rv = 0.5f - p.rivet_inset - std::fabs(v);
      const float rivet = Round(std::sqrt(ru * ru + rv * rv) / p.rivet_radius);
      relief = p.depth * raised + p.rivet_height * rivet;
      joint = 1.0f - raised;
      own = CellRandom(id, 1) - 0.5f;
      lean = p.tilt * ((CellRandom(id, 2) - 0.5f) * u + (CellRandom(id, 3) - 0.5f) * v);
    }
    const float dirt = p.dirt * Clamp01(joint + SmoothStep(0.1f, 0.6f, tone[i]) * (1.0f - relief));
    const float gain = (1.0f + p.plate_tone * own) * (1.0f + 0.08f * streaks[i]);
    out.height[i] = relief + lean + 0.03f * dents[i];
    out.r[i] = Mix(Clamp01(gain * p.color.r), p.groove.r, dirt);
    out.g[i] = Mix(Clamp01(gain * p.color.g), p.groove.g, dirt);
    out.b[i] = Mix(Clamp01(gain * p.color.b), p.groove.b, dirt);
    out.metal[i] = p.metal * (1.0f - dirt);
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness + p.plate_roughness * own + p.tone_roughness * tone[i] +
                       0.05f * streaks[i] + 0.4f * dirt;
  }
}

// Almost featureless sheets: plastic, lacquer, paper, cast and hammered metal.
struct SmoothSheet {
  NoiseOptions bumps, tone, gloss;
  Color color, second;
  float tone_strength, gloss_strength, metal, roughness, f0, dimple;
};

void SmoothSheetRow(SmoothSheet p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* bumps = NoiseRow(p.bumps, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const float* gloss = NoiseRow(p.gloss, d, s);
  for (int i = 0; i < d.n; ++i) {
    const float t = Clamp01(0.5f + p.tone_strength * tone[i]);
    out.height[i] = Mix(bumps[i], std::max(bumps[i], 0.0f), p.dimple);
    out.r[i] = Mix(p.color.r, p.second.r, t);
    out.g[i] = Mix(p.color.g, p.second.g, t);
    out.b[i] = Mix(p.color.b, p.second.b, t);
    out.metal[i] = p.metal;
    out.f0[i] = p.f0;
    out.roughness[i] = p.roughness + p.gloss_strength * gloss[i];
  }
}

}  // namespace

RowFunction DrawBrushed(Rng& rng) {
  Brushed p;
  p.warp = DrawWarp(rng, 0.7f, 3.0f, rng.Chance(0.3f) ? rng.Uniform(0.0f, 0.15f) : 0.0f);
  p.strokes = DrawNoise(rng, NoiseKind::kSmooth, 0.7f, 5.0f, 2);
  p.strokes.stretch = rng.Uniform(60.0f, 120.0f) / p.strokes.frequency / 2.0f;
  p.bands = DrawNoise(rng, NoiseKind::kSmooth, 0.3f, 2.0f, 3);
  p.bands.stretch = rng.LogUniform(4.0f, 20.0f);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 6.0f, 4);
  p.circular = rng.Chance(0.2f);
  p.metal = rng.Chance(0.85f) ? 1.0f : 0.0f;
  p.color = p.metal > 0.0f ? MetalColor(rng) : AnyColor(rng);
  p.tint = Related(rng, p.color, rng.Uniform(0.0f, 0.25f));
  p.relief = rng.Uniform(0.3f, 1.0f);
  p.stroke_roughness = rng.Uniform(0.0f, 0.2f);
  p.band_roughness = rng.Uniform(0.0f, 0.2f);
  p.tone_roughness = rng.Uniform(0.0f, 0.25f);
  p.stroke_tone = rng.Uniform(0.0f, 0.25f);
  p.roughness = AnyRoughness(rng, -0.3f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, BrushedRow);
}

RowFunction DrawScratched(Rng& rng) {
  Scratched p;
  for (StreakOptions& layer : p.layers) {
    layer.angle_turns = rng.Unit();
    layer.lanes = rng.LogUniform(6.0f, 40.0f);
    layer.length = rng.LogUniform(0.1f, 1.2f);
    layer.presence = rng.LogUniform(0.03f, 0.5f);
    layer.width = rng.LogUniform(0.5f, 3.0f) * layer.lanes / 256.0f;
    layer.bend = rng.Uniform(0.0f, 1.0f);
    layer.seed = rng.Seed();
  }
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 10.0f, 5);
  p.dents = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 12.0f, 2);
  p.fine = DrawNoise(rng, NoiseKind::kSmooth, 40.0f, 110.0f, 2);
  p.metal = rng.Chance(0.5f) ? 1.0f : 0.0f;
  p.color = p.metal > 0.0f ? MetalColor(rng) : AnyColor(rng);
  const bool through = p.metal == 0.0f && rng.Chance(0.4f);  // paint scratched down to metal
  p.scratch_metal = through ? 1.0f : p.metal;
  p.scratch_color = through ? MetalColor(rng) : Related(rng, p.color, 0.6f);
  p.depth = rng.Chance(0.8f) ? rng.Uniform(0.1f, 1.0f) : 0.0f;
  p.color_change = through ? rng.Uniform(0.6f, 1.0f) : rng.Uniform(0.0f, 0.8f);
  p.scratch_roughness = rng.Uniform(-0.15f, 0.4f);
  p.roughness = AnyRoughness(rng, -0.4f);
  p.tone_roughness = rng.Uniform(0.0f, 0.35f);
  p.tone_strength = rng.Uniform(0.0f, 0.3f);
  p.dent_depth = rng.Uniform(0.0f, 1.0f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, ScratchedRow);
}

RowFunction DrawFlakes(Rng& rng) {
  Flakes p;
  p.warp = DrawWarp(rng, 4.0f, 20.0f, rng.Uniform(0.0f, 0.3f));
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 8.0f, 4);
  p.frequency = rng.LogUniform(8.0f, 90.0f);
  p.second_frequency = p.frequency * rng.Uniform(0.6f, 1.5f);
  p.tilt = rng.Uniform(0.3f, 2.0f);
  p.flatness = rng.Unit();
  p.seed = rng.Seed();
  p.second_seed = rng.Seed();
  const bool metal = rng.Chance(0.75f);
  p.metal = metal ? 1.0f : 0.0f;
  const Color first = metal ? MetalColor(rng) : AnyColor(rng);
  const float spread = rng.Uniform(0.05f, 0.7f);
  for (Color& c : p.colors) c = Related(rng, first, spread);
  p.share = rng.Chance(0.5f) ? 1.0f : rng.Uniform(0.1f, 0.9f);
  const bool paint = rng.Chance(0.6f);
  p.ground = paint ? SaturatedColor(rng) : Related(rng, first, 0.3f);
  p.ground_metal = paint ? 0.0f : p.metal;
  p.sparkle = rng.Uniform(0.0f, 0.8f);
  p.tone_strength = rng.Uniform(0.0f, 0.3f);
  p.roughness = AnyRoughness(rng, -0.4f);
  p.roughness_spread = rng.Uniform(0.0f, 0.4f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, FlakesRow);
}

RowFunction DrawPlates(Rng& rng) {
  Plates p;
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 12.0f, 5);
  p.dents = DrawNoise(rng, NoiseKind::kSmooth, 2.0f, 12.0f, 2);
  p.streaks = DrawNoise(rng, NoiseKind::kSmooth, 0.8f, 3.0f, 3);
  p.streaks.stretch = rng.LogUniform(5.0f, 25.0f);
  p.tread = rng.Chance(0.3f);
  static constexpr Tiling kLayouts[] = {Tiling::kGrid, Tiling::kRunningBond, Tiling::kHexagon,
                                        Tiling::kBasket};
  p.tiling.tiling = p.tread ? Tiling::kGrid : kLayouts[rng.Int(0, 3)];
  p.tiling.aspect = p.tread ? 1 : rng.Int(1, 3);
  p.tiling.frequency = p.tread ? rng.LogUniform(5.0f, 20.0f) : rng.LogUniform(2.0f, 10.0f);
  p.tiling.seed = rng.Seed();
  p.metal = rng.Chance(0.75f) ? 1.0f : 0.0f;
  p.color = p.metal > 0.0f ? MetalColor(rng) : AnyColor(rng);
  p.groove = ScaleColor(EarthColor(rng), rng.Uniform(0.1f, 0.6f));
  p.joint = rng.LogUniform(0.005f, 0.03f);
  p.bevel = rng.LogUniform(0.01f, 0.1f);
  p.depth = rng.Uniform(0.1f, 1.0f);
  p.rivet_radius = rng.Uniform(0.03f, 0.07f);
  p.rivet_inset = rng.Uniform(0.1f, 0.16f);
  p.rivet_height = rng.Chance(0.6f) ? rng.Uniform(-0.5f, 1.0f) : 0.0f;
  p.plate_tone = rng.Uniform(0.0f, 0.3f);
  p.plate_roughness = rng.Uniform(0.0f, 0.3f);
  p.tilt = rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.3f) : 0.0f;
  p.tread_size = rng.Uniform(0.4f, 0.6f);
  p.roughness = AnyRoughness(rng, -0.3f);
  p.tone_roughness = rng.Uniform(0.0f, 0.3f);
  p.dirt = rng.Chance(0.5f) ? rng.Uniform(0.0f, 0.8f) : 0.0f;
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, PlatesRow);
}

RowFunction DrawSmooth(Rng& rng) {
  SmoothSheet p;
  const float kind = rng.Unit();
  p.bumps = DrawNoise(rng,
                      kind < 0.6f   ? NoiseKind::kSmooth
                      : kind < 0.8f ? NoiseKind::kBillow
                                    : NoiseKind::kRidged,
                      3.0f, 90.0f, rng.Int(1, 3));
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 0.8f, 20.0f, 4);
  p.gloss = DrawNoise(rng, NoiseKind::kSmooth, 0.8f, 20.0f, 4);
  p.metal = rng.Chance(0.3f) ? 1.0f : 0.0f;
  p.color = p.metal > 0.0f ? MetalColor(rng) : AnyColor(rng);
  p.second = Related(rng, p.color, rng.Uniform(0.02f, 0.3f));
  p.tone_strength = rng.Uniform(0.0f, 1.0f);
  p.gloss_strength = rng.Chance(0.6f) ? rng.Uniform(0.0f, 0.3f) : 0.0f;
  p.roughness = AnyRoughness(rng, -0.2f);
  p.f0 = AnyDielectricF0(rng);
  p.dimple = rng.Chance(0.3f) ? 1.0f : 0.0f;
  return Bind(p, SmoothSheetRow);
}

}  // namespace glint::procedural
