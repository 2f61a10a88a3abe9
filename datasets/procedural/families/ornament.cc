// Designed surfaces: stripes, dots, stamped shapes and printed or inlaid figures.
#include "datasets/procedural/families/common.h"
#include "datasets/procedural/families/families.h"

namespace glint::procedural {
namespace {

// Two finishes, figure and ground; each may be metal.
struct Finish {
  Color color;
  float metal, roughness, f0;
};

Finish DrawFinish(Rng& rng, float metal_chance) {
  Finish f;
  f.metal = rng.Chance(metal_chance) ? 1.0f : 0.0f;
  f.color = f.metal > 0.0f ? MetalColor(rng) : AnyColor(rng);
  f.roughness = AnyRoughness(rng, f.metal > 0.0f ? -0.3f : 0.0f);
  f.f0 = AnyDielectricF0(rng);
  return f;
}

// The figure's finish: often the ground's with one thing changed.
Finish DrawFigure(Rng& rng, const Finish& ground) {
  Finish f = ground;
  const float kind = rng.Unit();
  if (kind < 0.25f) return f;  // relief alone
  if (kind < 0.45f) {
    f.roughness = AnyRoughness(rng);  // gloss alone
    return f;
  }
  if (kind < 0.65f) {
    f.color = ground.metal > 0.0f ? MetalColor(rng) : Related(rng, ground.color, 0.9f);
    f.roughness = std::clamp(ground.roughness + rng.Uniform(-0.2f, 0.2f), 0.06f, 1.0f);
    return f;
  }
  return DrawFinish(rng, 0.25f);
}

void Lay(const Finish& a, const Finish& b, float t, float gain, const RowLayers& out, int i) {
  out.r[i] = Clamp01(gain * Mix(a.color.r, b.color.r, t));
  out.g[i] = Clamp01(gain * Mix(a.color.g, b.color.g, t));
  out.b[i] = Clamp01(gain * Mix(a.color.b, b.color.b, t));
  out.metal[i] = Mix(a.metal, b.metal, t);
  out.f0[i] = Mix(a.f0, b.f0, t);
  out.roughness[i] = Mix(a.roughness, b.roughness, t);
}

struct Ground {
  NoiseOptions grain, tone;
  float grain_relief, grain_tone, tone_strength, tone_roughness;
};

Ground DrawGround(Rng& rng) {
  Ground g;
  g.grain = DrawNoise(rng, NoiseKind::kSmooth, 20.0f, 110.0f, 2);
  g.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 12.0f, 4);
  g.grain_relief = rng.Chance(0.6f) ? rng.Uniform(0.0f, 0.15f) : 0.0f;
  g.grain_tone = rng.Uniform(0.0f, 0.25f);
  g.tone_strength = rng.Uniform(0.0f, 0.4f);
  g.tone_roughness = rng.Uniform(0.0f, 0.25f);
  return g;
}

struct Stripes {
  Ground ground;
  Warp warp;
  Finish finishes[4];
  float frequency, width, soft, relief, ridge, ridge_count, lattice;
  int kinds;
};

void StripesRow(Stripes p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* grain = NoiseRow(p.ground.grain, d, s);
  const float* tone = NoiseRow(p.ground.tone, d, s);
  const RowDomain w = Warped(p.warp, d, s);
  const float soft = EdgeWidth(p.soft, p.frequency, d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const float across = w.y[i] * p.frequency, other = w.x[i] * p.frequency;
    const int32_t lane = FloorInt(across);
    const float v = std::fabs(across - static_cast<float>(lane) - 0.5f);
    const int32_t column = FloorInt(other);
    const float u = std::fabs(other - static_cast<float>(column) - 0.5f);
    const float stripe = SmoothStep(-0.5f * soft, 0.5f * soft, 0.5f * p.width - v);
    const float bar = p.lattice * SmoothStep(-0.5f * soft, 0.5f * soft, 0.5f * p.width - u);
    const float figure = std::max(stripe, bar);
    const float wale = Round(2.0f * v) + p.lattice * Round(2.0f * u);
    const float fine = CosTurn(across * p.ridge_count);
    const int kind = p.kinds <= 1 ? 1 : 1 + ((lane % p.kinds) + p.kinds) % p.kinds;
    const float gain = 1.0f + p.ground.grain_tone * grain[i] + p.ground.tone_strength * tone[i];
    Lay(p.finishes[0], p.finishes[kind], figure, gain, out, i);
    out.height[i] = p.relief * figure + p.ridge * wale + 0.1f * p.ridge * fine +
                    p.ground.grain_relief * grain[i];
    out.roughness[i] += p.ground.tone_roughness * tone[i];
  }
}

enum class DotProfile { kDome, kHole, kRing, kFlat, kPyramid };

struct Dots {
  Ground ground;
  Warp warp;
  Finish base, dot;
  Tiling tiling;
  float frequency, radius, radius_spread, jitter, soft, relief, presence;
  DotProfile profile;
  bool square;
  uint32_t seed;
};

void DotsRow(Dots p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* grain = NoiseRow(p.ground.grain, d, s);
  const float* tone = NoiseRow(p.ground.tone, d, s);
  const RowDomain w = Warped(p.warp, d, s);
  const TilingRows cells = TakeTilingRows(s);
  Tile({p.tiling, p.frequency, 1, 0.6f, p.seed}, w.x, w.y, d.n, cells);
  const float soft = EdgeWidth(p.soft, p.frequency, d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const uint32_t id = cells.id[i];
    const float u = cells.u[i] + p.jitter * (CellRandom(id, 1) - 0.5f);
    const float v = cells.v[i] + p.jitter * (CellRandom(id, 2) - 0.5f);
    const float r = p.square ? std::max(std::fabs(u), std::fabs(v)) : std::sqrt(u * u + v * v);
    const float radius = p.radius * (1.0f + p.radius_spread * (CellRandom(id, 3) - 0.5f));
    const float there = CellRandom(id, 4) < p.presence ? 1.0f : 0.0f;
    const float inside = there * SmoothStep(-0.5f * soft, 0.5f * soft, radius - r);
    const float q = r / radius;
    float h = 0.0f;
    switch (p.profile) {
      case DotProfile::kDome:
        h = Round(q);
        break;
      case DotProfile::kHole:
        h = -inside;
        break;
      case DotProfile::kRing:
        h = Round(4.0f * (q - 0.75f));
        break;
      case DotProfile::kFlat:
        h = inside;
        break;
      case DotProfile::kPyramid:
        h = std::max(1.0f - q, 0.0f);
        break;
    }
    const float gain = 1.0f + p.ground.grain_tone * grain[i] + p.ground.tone_strength * tone[i];
    Lay(p.base, p.dot, inside, gain, out, i);
    out.height[i] = p.relief * there * h + p.ground.grain_relief * grain[i];
    out.roughness[i] += p.ground.tone_roughness * tone[i];
  }
}

struct Stamps {
  Ground ground;
  Warp warp;
  Finish base, figure;
  Tiling tiling;
  float frequency, soft, relief, spin, size, presence, bitmap_share;
  int bitmap;  // squares of a glyph's bitmap per side
  bool mirrored;
  int shapes;  // of the simple shapes in use, 1 to 6
  uint32_t seed;
};

// Negative inside; sizes in cells.
inline float ShapeDistance(int shape, float u, float v, float size) {
  const float a = std::fabs(u), b = std::fabs(v);
  const float r = std::sqrt(u * u + v * v);
  switch (shape) {
    case 0:
      return std::fabs(r - 0.75f * size) - 0.2f * size;  // ring
    case 1:
      return std::max(a, b) - size * 0.8f;  // square
    case 2:
      return std::min(std::max(a - size, b - 0.28f * size), std::max(b - size, a - 0.28f * size));
    case 3:
      return 0.72f * (a + b - 1.1f * size);  // diamond
    case 4:
      return std::max(0.866f * a + 0.5f * v, -v) - 0.5f * size;  // triangle
    default:
      return r -
             size * (0.62f + 0.38f * CosTurn(5.0f * std::atan2(v, u) / (2.0f * kPi)));  // flower
  }
}

inline float GlyphBit(uint32_t id, int n, bool mirrored, int32_t x, int32_t y) {
  const bool outside = x < 0 || y < 0 || x >= n || y >= n;
  const int32_t fold = mirrored ? std::min(x, n - 1 - x) : x;
  return outside ? 0.0f : ((Hash2(fold, y, id) >> 9) & 1u) != 0u ? 1.0f : 0.0f;
}

// A random bitmap with its corners rounded, thresholded at one half.
inline float GlyphDistance(uint32_t id, int n, bool mirrored, float u, float v, float size) {
  const float scale = 0.5f * static_cast<float>(n) / size;
  const float x = u * scale + 0.5f * static_cast<float>(n) - 0.5f;
  const float y = v * scale + 0.5f * static_cast<float>(n) - 0.5f;
  const int32_t ix = FloorInt(x), iy = FloorInt(y);
  const float fx = x - static_cast<float>(ix), fy = y - static_cast<float>(iy);
  const float low =
      Mix(GlyphBit(id, n, mirrored, ix, iy), GlyphBit(id, n, mirrored, ix + 1, iy), fx);
  const float high =
      Mix(GlyphBit(id, n, mirrored, ix, iy + 1), GlyphBit(id, n, mirrored, ix + 1, iy + 1), fx);
  return (0.5f - Mix(low, high, fy)) / scale;
}

void StampsRow(Stamps p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* grain = NoiseRow(p.ground.grain, d, s);
  const float* tone = NoiseRow(p.ground.tone, d, s);
  const RowDomain w = Warped(p.warp, d, s);
  const TilingRows cells = TakeTilingRows(s);
  Tile({p.tiling, p.frequency, 1, 0.5f, p.seed}, w.x, w.y, d.n, cells);
  const float soft = EdgeWidth(p.soft, p.frequency, d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const uint32_t id = cells.id[i];
    const float turn = p.spin * CellRandom(id, 1);
    const float c = CosTurn(turn), sn = SinTurn(turn);
    const float u = c * cells.u[i] - sn * cells.v[i], v = sn * cells.u[i] + c * cells.v[i];
    const int shape = static_cast<int>(static_cast<float>(p.shapes) * CellRandom(id, 2));
    const float distance =
        CellRandom(id, 3) < p.bitmap_share
            ? GlyphDistance(id, p.bitmap, p.mirrored, u, v, p.size)
            : ShapeDistance(static_cast<int>((static_cast<uint32_t>(shape) + p.seed) % 6u), u, v,
                            p.size);
    const float there = CellRandom(id, 4) < p.presence ? 1.0f : 0.0f;
    const float figure = there * SmoothStep(-0.5f * soft, 0.5f * soft, -distance);
    const float gain = 1.0f + p.ground.grain_tone * grain[i] + p.ground.tone_strength * tone[i];
    Lay(p.base, p.figure, figure, gain, out, i);
    out.height[i] = p.relief * figure + p.ground.grain_relief * grain[i];
    out.roughness[i] += p.ground.tone_roughness * tone[i];
  }
}

// Sums of plane waves at equal angles, thresholded: rosettes, quasicrystals, wallpaper, camouflage.
struct Damask {
  Ground ground;
  Warp warp;
  Finish base, figure;
  int waves;
  float frequency, level, soft, relief, second, second_ratio;
  float phase[6];
};

void DamaskRow(Damask p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* grain = NoiseRow(p.ground.grain, d, s);
  const float* tone = NoiseRow(p.ground.tone, d, s);
  const RowDomain w = Warped(p.warp, d, s);
  float* sum = s.Row();
  SetAll(sum, d.n, 0.0f);
  for (int k = 0; k < p.waves; ++k) {
    const float turn = 0.5f * static_cast<float>(k) / static_cast<float>(p.waves);
    const float c = p.frequency * CosTurn(turn), sn = p.frequency * SinTurn(turn);
    const float phase = p.phase[k];
    for (int i = 0; i < d.n; ++i) {
      const float t = c * w.x[i] + sn * w.y[i] + phase;
      sum[i] += CosTurn(t) + p.second * CosTurn(p.second_ratio * t);
    }
  }
  const float scale = 1.0f / (static_cast<float>(p.waves) * (1.0f + p.second));
  const float soft =
      EdgeWidth(p.soft, p.frequency * std::max(1.0f, p.second * p.second_ratio), d.pixel);
  for (int i = 0; i < d.n; ++i) {
    const float field = sum[i] * scale;
    const float figure = SmoothStep(-0.5f * soft, 0.5f * soft, field - p.level);
    const float gain = 1.0f + p.ground.grain_tone * grain[i] + p.ground.tone_strength * tone[i];
    Lay(p.base, p.figure, figure, gain, out, i);
    out.height[i] =
        p.relief * figure + 0.3f * std::fabs(p.relief) * field + p.ground.grain_relief * grain[i];
    out.roughness[i] += p.ground.tone_roughness * tone[i];
  }
}

float DrawRelief(Rng& rng) {
  if (rng.Chance(0.2f)) return 0.0f;
  return rng.Uniform(0.2f, 1.0f) * (rng.Chance(0.6f) ? 1.0f : -1.0f);
}

}  // namespace

RowFunction DrawStripes(Rng& rng) {
  Stripes p;
  p.ground = DrawGround(rng);
  p.warp = DrawWarp(rng, 1.0f, 6.0f, rng.Chance(0.5f) ? rng.Uniform(0.0f, 0.3f) : 0.0f);
  p.finishes[0] = DrawFinish(rng, 0.2f);
  for (int k = 1; k < 4; ++k) p.finishes[k] = DrawFigure(rng, p.finishes[0]);
  p.kinds = rng.Int(1, 3);
  p.frequency = rng.LogUniform(3.0f, 40.0f);
  p.width = rng.Uniform(0.1f, 0.9f);
  p.soft = rng.LogUniform(0.02f, 0.5f);
  p.relief = DrawRelief(rng);
  p.ridge = rng.Chance(0.5f) ? rng.Uniform(0.0f, 1.0f) : 0.0f;  // corduroy
  p.ridge_count = static_cast<float>(rng.Int(1, 4));
  p.lattice = rng.Chance(0.25f) ? 1.0f : 0.0f;
  return Bind(p, StripesRow);
}

RowFunction DrawDots(Rng& rng) {
  Dots p;
  p.ground = DrawGround(rng);
  p.warp = DrawWarp(rng, 1.0f, 6.0f, rng.Chance(0.3f) ? rng.Uniform(0.0f, 0.2f) : 0.0f);
  p.base = DrawFinish(rng, 0.3f);
  p.dot = DrawFigure(rng, p.base);
  static constexpr Tiling kLayouts[] = {Tiling::kGrid, Tiling::kRunningBond, Tiling::kHexagon,
                                        Tiling::kVoronoi};
  p.tiling = kLayouts[rng.Int(0, 3)];
  p.frequency = rng.LogUniform(4.0f, 36.0f);
  p.radius = rng.Uniform(0.12f, 0.46f);
  p.radius_spread = rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.9f) : 0.0f;
  p.jitter = rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.9f) * (1.0f - 2.0f * p.radius) : 0.0f;
  p.soft = rng.LogUniform(0.02f, 0.2f);
  p.relief =
      rng.Chance(0.85f) ? rng.Uniform(0.2f, 1.0f) * (rng.Chance(0.75f) ? 1.0f : -1.0f) : 0.0f;
  p.presence = rng.Chance(0.7f) ? 1.0f : rng.Uniform(0.3f, 1.0f);
  p.profile = static_cast<DotProfile>(rng.Int(0, 4));
  p.square = rng.Chance(0.2f);
  p.seed = rng.Seed();
  if (p.profile == DotProfile::kHole && rng.Chance(0.7f)) {  // perforation: dark inside
    p.dot = {{0.006f, 0.006f, 0.006f}, 0.0f, rng.Uniform(0.6f, 1.0f), 0.03f};
  }
  return Bind(p, DotsRow);
}

RowFunction DrawStamps(Rng& rng) {
  Stamps p;
  p.ground = DrawGround(rng);
  p.warp = DrawWarp(rng, 1.0f, 6.0f, rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.15f) : 0.0f);
  p.base = DrawFinish(rng, 0.3f);
  p.figure = DrawFigure(rng, p.base);
  static constexpr Tiling kLayouts[] = {Tiling::kGrid, Tiling::kRunningBond, Tiling::kHexagon,
                                        Tiling::kVoronoi};
  p.tiling = kLayouts[rng.Int(0, 3)];
  p.frequency = rng.LogUniform(2.0f, 14.0f);
  p.soft = rng.LogUniform(0.01f, 0.12f);
  p.relief = DrawRelief(rng);
  p.spin = rng.Chance(0.5f) ? 1.0f : 0.0f;
  p.size = rng.Uniform(0.2f, 0.42f);
  p.presence = rng.Uniform(0.5f, 1.1f);
  p.bitmap_share = rng.Chance(0.4f) ? 1.0f : rng.Chance(0.5f) ? 0.0f : rng.Unit();
  p.bitmap = rng.Int(3, 6);
  p.mirrored = rng.Chance(0.6f);
  p.shapes = rng.Int(1, 6);
  p.seed = rng.Seed();
  return Bind(p, StampsRow);
}

RowFunction DrawDamask(Rng& rng) {
  Damask p;
  p.ground = DrawGround(rng);
  p.warp = DrawWarp(rng, 1.0f, 6.0f, rng.Chance(0.5f) ? rng.Uniform(0.0f, 0.7f) : 0.0f);
  p.base = DrawFinish(rng, 0.3f);
  p.figure = DrawFigure(rng, p.base);
  p.waves = rng.Int(2, 6);
  p.frequency = rng.LogUniform(2.5f, 24.0f);
  p.level = rng.Uniform(-0.15f, 0.35f);
  p.soft = rng.LogUniform(0.02f, 0.8f);
  p.relief = DrawRelief(rng);
  p.second = rng.Chance(0.5f) ? rng.Uniform(0.0f, 1.0f) : 0.0f;
  p.second_ratio = static_cast<float>(rng.Int(2, 3));
  const bool centred = rng.Chance(0.5f);
  for (float& phase : p.phase) phase = centred ? 0.0f : rng.Unit();
  return Bind(p, DamaskRow);
}

}  // namespace glint::procedural
