// Goods that were pressed, punched, beaten or upholstered into shape.
#include "datasets/procedural/families/common.h"
#include "datasets/procedural/families/families.h"

namespace glint::procedural {
namespace {

// What the sheets share: a colour with tone, wear on what stands out, dirt in what lies low.
struct Sheet {
  NoiseOptions tone, fine;
  Color color, second, worn_color, dirt;
  float metal, wear, wear_level, dirt_strength, tone_strength, fine_relief;
  float roughness, worn_roughness, roughness_spread, f0;
};

Sheet DrawSheet(Rng& rng, float metal_share) {
  Sheet f;
  f.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 10.0f, 5);
  f.fine = DrawNoise(rng, NoiseKind::kSmooth, 30.0f, 100.0f, 2);
  const bool metal = rng.Chance(metal_share);
  f.metal = metal ? 1.0f : 0.0f;
  f.color = metal ? MetalColor(rng) : AnyColor(rng);
  f.second = Related(rng, f.color, metal ? 0.1f : 0.3f);
  f.worn_color = metal ? ScaleColor(f.color, 1.15f) : Related(rng, f.color, 0.6f);
  f.dirt = ScaleColor(EarthColor(rng), 0.5f);
  f.wear = rng.Chance(0.6f) ? rng.Unit() : 0.0f;
  f.wear_level = rng.Uniform(0.3f, 0.9f);
  f.dirt_strength = rng.Chance(0.4f) ? rng.Uniform(0.1f, 0.9f) : 0.0f;
  f.tone_strength = rng.Uniform(0.0f, 0.4f);
  f.fine_relief = rng.Uniform(0.0f, 0.04f);
  f.roughness = AnyRoughness(rng, metal ? -0.3f : 0.0f);
  f.worn_roughness = std::max(f.roughness - rng.Uniform(0.0f, 0.4f), 0.06f);
  f.roughness_spread = rng.Uniform(0.0f, 0.2f);
  f.f0 = AnyDielectricF0(rng);
  return f;
}

// Colours the relief in out.height, 0 low … 1 high.
void ColorSheet(const Sheet& f, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* tone = NoiseRow(f.tone, d, s);
  const float* fine = NoiseRow(f.fine, d, s);
  const Sheet p = f;
  for (int i = 0; i < d.n; ++i) {
    const float h = out.height[i] + 0.15f * tone[i];
    const float worn = p.wear * SmoothStep(p.wear_level, p.wear_level + 0.3f, h);
    const float dirt = p.dirt_strength * (1.0f - SmoothStep(0.0f, 0.45f, h + 0.1f * fine[i]));
    const float t = Clamp01(0.5f + 0.7f * tone[i]);
    const float gain = 1.0f + p.tone_strength * tone[i] + 0.05f * fine[i];
    out.height[i] += p.fine_relief * fine[i];
    out.r[i] = Mix(Mix(gain * Mix(p.color.r, p.second.r, t), p.worn_color.r, worn), p.dirt.r, dirt);
    out.g[i] = Mix(Mix(gain * Mix(p.color.g, p.second.g, t), p.worn_color.g, worn), p.dirt.g, dirt);
    out.b[i] = Mix(Mix(gain * Mix(p.color.b, p.second.b, t), p.worn_color.b, worn), p.dirt.b, dirt);
    out.metal[i] = p.metal * (1.0f - dirt);
    out.f0[i] = p.f0;
    out.roughness[i] =
        Mix(Mix(p.roughness + p.roughness_spread * tone[i], p.worn_roughness, worn), 0.85f, dirt);
  }
}

struct Corrugated {
  Sheet sheet;
  Warp warp;
  float frequency, sharpness, seam_frequency, seam_shift;
};

void CorrugatedRow(Corrugated p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  for (int i = 0; i < d.n; ++i) {
    const float sheet = w.y[i] * p.seam_frequency;
    const float shift = p.seam_shift * static_cast<float>(FloorInt(sheet));
    const float wave = SinTurn(w.x[i] * p.frequency + shift);
    // From round waves to flat ribs with steep flanks.
    const float rib = std::clamp(p.sharpness * wave, -1.0f, 1.0f);
    const float seam = SmoothStep(0.0f, 0.03f, Fract(sheet));
    out.height[i] = 0.5f + 0.5f * Mix(-0.6f, rib, 0.3f + 0.7f * seam);
  }
  ColorSheet(p.sheet, d, s, out);
}

// Anti-slip plate: lenses turned this way and that on a checker of cells.
struct Tread {
  Sheet sheet;
  float frequency, length, width, bars;
};

void TreadRow(Tread p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  for (int i = 0; i < d.n; ++i) {
    const float px = d.x[i] * p.frequency, py = d.y[i] * p.frequency;
    const int32_t ix = FloorInt(px), iy = FloorInt(py);
    const float fx = px - static_cast<float>(ix) - 0.5f, fy = py - static_cast<float>(iy) - 0.5f;
    const bool turned = ((ix + iy) & 1) != 0;
    const float u = (turned ? fy : fx) / p.length, across = (turned ? fx : fy);
    const float bar = (Fract(across * p.bars + 0.5f) - 0.5f) / (p.bars * p.width);
    const float inside = std::fabs(across) * p.bars < 0.5f * p.bars * 0.9f ? 1.0f : 0.0f;
    const float lens = 1.0f - u * u - std::fabs(bar);
    out.height[i] = inside * SmoothStep(0.0f, 0.45f, lens);
  }
  ColorSheet(p.sheet, d, s, out);
}

struct Hammered {
  Sheet sheet;
  float frequency, depth_spread, rim;
  uint32_t seed;
};

void HammeredRow(Hammered p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const TilingRows cells = TakeTilingRows(s);
  Voronoi(p.frequency, 0.8f, p.seed, d.x, d.y, d.n, {cells.u, cells.v, cells.edge, cells.id});
  for (int i = 0; i < d.n; ++i) {
    const float reach = cells.u[i] * cells.u[i] + cells.v[i] * cells.v[i];
    const float depth = 1.0f - p.depth_spread * CellRandom(cells.id[i], 1);
    const float rim = p.rim * (1.0f - SmoothStep(0.0f, 0.12f, cells.edge[i]));
    out.height[i] = 0.2f + 1.6f * depth * reach + rim;
  }
  ColorSheet(p.sheet, d, s, out);
}

struct Perforated {
  Sheet sheet;
  TilingOptions holes;
  float radius, square, bevel, dark;
};

void PerforatedRow(Perforated p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const TilingRows cells = TakeTilingRows(s);
  Tile(p.holes, d.x, d.y, d.n, cells);
  const float bevel = EdgeWidth(p.bevel, p.holes.frequency, d.pixel);
  float* solid = s.Row();
  for (int i = 0; i < d.n; ++i) {
    const float u = std::fabs(cells.u[i]), v = std::fabs(cells.v[i]);
    const float reach = Mix(std::sqrt(u * u + v * v), std::max(u, v), p.square);
    solid[i] = SmoothStep(p.radius, p.radius + bevel, reach);
    out.height[i] = solid[i];
  }
  ColorSheet(p.sheet, d, s, out);
  const float dark = p.dark;
  for (int i = 0; i < d.n; ++i) {
    const float gain = Mix(dark, 1.0f, solid[i]);
    out.r[i] *= gain;
    out.g[i] *= gain;
    out.b[i] *= gain;
    out.roughness[i] = Mix(0.8f, out.roughness[i], solid[i]);
  }
}

// Upholstery: cushions between seams, with stitches and buttons.
struct Quilted {
  Sheet sheet;
  Warp warp;
  float frequency, aspect, seam, stitches, button, wrinkle_depth;
  NoiseOptions wrinkles;
};

void QuiltedRow(Quilted p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* wrinkles = NoiseRow(p.wrinkles, w, s);
  for (int i = 0; i < d.n; ++i) {
    const float a = p.frequency * (w.x[i] + p.aspect * w.y[i]);
    const float b = p.frequency * (w.x[i] - p.aspect * w.y[i]);
    const float fa = Fract(a), fb = Fract(b);
    const float ea = std::min(fa, 1.0f - fa), eb = std::min(fb, 1.0f - fb);
    const float near = std::min(ea, eb), other = ea < eb ? b : a;
    const float cushion =
        std::sqrt(Clamp01(4.0f * fa * (1.0f - fa)) * Clamp01(4.0f * fb * (1.0f - fb)));
    const float on_seam = 1.0f - Clamp01(near / p.seam);
    const float stitch = on_seam * SmoothStep(-0.2f, 0.4f, SinTurn(other * p.stitches));
    const float corner = ea * ea + eb * eb, radius = p.button * p.button;
    const float button = p.button > 0.0f ? SmoothStep(0.0f, 0.4f, 1.0f - corner / radius) : 0.0f;
    out.height[i] = Mix(0.9f * cushion + 0.08f * stitch, 0.35f, button) +
                    p.wrinkle_depth * wrinkles[i] * (1.0f - cushion);
  }
  ColorSheet(p.sheet, d, s, out);
}

// Carpet and towel: tufts that lean and differ in tone, in patterned fields.
struct Pile {
  Sheet sheet;
  Warp warp;
  NoiseOptions fields, fibre;
  float frequency, lean, shadow, id_tone, level;
  uint32_t seed;
  Color colors[2];
};

void PileRow(Pile p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const TilingRows cells = TakeTilingRows(s);
  Voronoi(p.frequency, 0.75f, p.seed, w.x, w.y, d.n, {cells.u, cells.v, cells.edge, cells.id});
  const float* fields = NoiseRow(p.fields, d, s);
  const float* fibre = NoiseRow(p.fibre, w, s);
  for (int i = 0; i < d.n; ++i) {
    const uint32_t id = cells.id[i];
    const float reach = cells.u[i] * cells.u[i] + cells.v[i] * cells.v[i];
    const float lean = p.lean * ((CellRandom(id, 1) - 0.5f) * cells.u[i] +
                                 (CellRandom(id, 2) - 0.5f) * cells.v[i]);
    const float tuft = Clamp01(1.0f - 1.6f * reach) + lean + 0.25f * fibre[i];
    const float field = SmoothStep(p.level - 0.05f, p.level + 0.05f, fields[i]);
    const float gain = (1.0f - p.shadow + p.shadow * Clamp01(1.3f * tuft)) *
                       (1.0f + p.id_tone * (CellRandom(id, 3) - 0.5f) + 0.3f * fibre[i]);
    out.height[i] = tuft + 0.4f * (CellRandom(id, 4) - 0.5f);
    out.r[i] = gain * Mix(p.colors[0].r, p.colors[1].r, field);
    out.g[i] = gain * Mix(p.colors[0].g, p.colors[1].g, field);
    out.b[i] = gain * Mix(p.colors[0].b, p.colors[1].b, field);
    out.metal[i] = 0.0f;
    out.f0[i] = p.sheet.f0;
    out.roughness[i] = p.sheet.roughness + 0.1f * fibre[i] - 0.1f * Clamp01(tuft);
  }
}

}  // namespace

RowFunction DrawCorrugated(Rng& rng) {
  Corrugated p;
  p.sheet = DrawSheet(rng, 0.6f);
  p.warp = DrawWarp(rng, 1.0f, 4.0f, rng.Chance(0.3f) ? rng.Uniform(0.0f, 0.02f) : 0.0f);
  p.frequency = rng.LogUniform(3.0f, 30.0f);
  p.sharpness = rng.LogUniform(1.0f, 4.0f);
  p.seam_frequency = rng.LogUniform(0.3f, 2.0f);
  p.seam_shift = rng.Chance(0.3f) ? rng.Unit() : 0.0f;
  return Bind(p, CorrugatedRow);
}

RowFunction DrawTread(Rng& rng) {
  Tread p;
  p.sheet = DrawSheet(rng, 0.8f);
  p.frequency = rng.LogUniform(4.0f, 18.0f);
  p.length = rng.Uniform(0.38f, 0.5f);
  p.bars = static_cast<float>(rng.Chance(0.6f) ? 1 : rng.Int(2, 5));
  p.width = p.bars > 1.0f ? rng.Uniform(0.25f, 0.45f) : rng.Uniform(0.12f, 0.3f);
  return Bind(p, TreadRow);
}

RowFunction DrawHammered(Rng& rng) {
  Hammered p;
  p.sheet = DrawSheet(rng, 0.85f);
  p.frequency = rng.LogUniform(4.0f, 30.0f);
  p.depth_spread = rng.Unit();
  p.rim = rng.Uniform(-0.1f, 0.2f);
  p.seed = rng.Seed();
  return Bind(p, HammeredRow);
}

RowFunction DrawPerforated(Rng& rng) {
  Perforated p;
  p.sheet = DrawSheet(rng, 0.7f);
  p.holes.tiling = rng.Chance(0.6f) ? Tiling::kHexagon : Tiling::kGrid;
  p.holes.aspect = 1;
  p.holes.frequency = rng.LogUniform(4.0f, 20.0f);
  p.holes.seed = rng.Seed();
  p.radius = rng.Uniform(0.15f, 0.42f);
  p.square = rng.Chance(0.25f) ? rng.Unit() : 0.0f;
  p.bevel = rng.LogUniform(0.02f, 0.15f);
  p.dark = rng.Uniform(0.03f, 0.4f);
  return Bind(p, PerforatedRow);
}

RowFunction DrawQuilted(Rng& rng) {
  Quilted p;
  p.sheet = DrawSheet(rng, 0.02f);
  p.warp = DrawWarp(rng, 1.5f, 5.0f, rng.Uniform(0.0f, 0.06f));
  p.frequency = rng.LogUniform(1.5f, 9.0f);
  p.aspect = rng.LogUniform(0.5f, 1.5f);
  p.seam = rng.Uniform(0.02f, 0.07f);
  p.stitches = rng.Uniform(4.0f, 14.0f);
  p.button = rng.Chance(0.4f) ? rng.Uniform(0.1f, 0.2f) : 0.0f;
  p.wrinkle_depth = rng.Uniform(0.0f, 0.4f);
  p.wrinkles = DrawNoise(rng, NoiseKind::kRidged, 5.0f, 20.0f, 3);
  return Bind(p, QuiltedRow);
}

RowFunction DrawPile(Rng& rng) {
  Pile p;
  p.sheet = DrawSheet(rng, 0.0f);
  p.sheet.roughness = rng.Uniform(0.6f, 1.0f);
  p.warp = DrawWarp(rng, 4.0f, 20.0f, rng.Uniform(0.0f, 0.3f));
  p.fields = DrawNoise(rng, NoiseKind::kSmooth, 0.8f, 5.0f, rng.Int(1, 4));
  p.fibre = DrawNoise(rng, NoiseKind::kSmooth, 60.0f, 110.0f, 2);
  p.frequency = rng.LogUniform(15.0f, 80.0f);
  p.lean = rng.Uniform(0.0f, 1.5f);
  p.shadow = rng.Uniform(0.2f, 0.9f);
  p.id_tone = rng.Uniform(0.0f, 0.8f);
  p.level = rng.Chance(0.5f) ? rng.Uniform(-0.3f, 0.3f) : 9.0f;
  p.seed = rng.Seed();
  p.colors[0] = AnyColor(rng);
  p.colors[1] = rng.Chance(0.6f) ? Related(rng, p.colors[0], 0.7f) : AnyColor(rng);
  return Bind(p, PileRow);
}

}  // namespace glint::procedural
