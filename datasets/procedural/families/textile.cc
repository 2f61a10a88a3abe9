// Woven, knitted and felted cloth, and other surfaces of strands.
#include "datasets/procedural/families/common.h"
#include "datasets/procedural/families/families.h"

namespace glint::procedural {
namespace {

struct Weave {
  Warp warp;
  NoiseOptions fuzz, tone;
  float frequency, aspect;  // threads per unit; weft threads per warp thread
  int over, period, step;   // a warp thread is on top where (i·step + j) mod period < over
  float width, sink;        // of a thread in its lane; depth of the lower thread
  Color warp_color, weft_color, stripe_color;
  int stripe_period, stripe_width;  // in threads; width 0 = none
  float thread_tone, gap_dark, fuzz_relief, fuzz_tone, twist;
  float roughness, roughness_spread, f0, metal;
};

inline float OnTop(const Weave& p, int32_t i, int32_t j) {
  const int32_t phase = ((i * p.step + j) % p.period + p.period) % p.period;
  return phase < p.over ? 1.0f : 0.0f;
}

void WeaveRow(Weave p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* fuzz = NoiseRow(p.fuzz, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const RowDomain w = Warped(p.warp, d, s);
  const float fy = p.frequency * p.aspect;
  // Threads thinner than two texels lose their relief and contrast.
  const float clear = Clamp01(2.0f - 3.2f * std::max(p.frequency, fy) * d.pixel);
  for (int k = 0; k < d.n; ++k) {
    const float px = w.x[k] * p.frequency, py = w.y[k] * fy;
    const int32_t i = FloorInt(px), j = FloorInt(py);
    const float u = px - static_cast<float>(i) - 0.5f, v = py - static_cast<float>(j) - 0.5f;
    // How high each thread rides, smoothed between crossings.
    const float here = OnTop(p, i, j);
    const float lift_warp =
        Mix(here, OnTop(p, i, v > 0.0f ? j + 1 : j - 1), 0.5f * Smooth(2.0f * std::fabs(v)));
    const float lift_weft =
        Mix(here, OnTop(p, u > 0.0f ? i + 1 : i - 1, j), 0.5f * Smooth(2.0f * std::fabs(u)));
    const float section_warp = Round(2.0f * u / p.width), section_weft = Round(2.0f * v / p.width);
    const float h_warp = section_warp * (1.0f - p.sink + p.sink * lift_warp);
    const float h_weft = section_weft * (1.0f - p.sink * lift_weft);
    const float warp_above = SmoothStep(-0.12f, 0.12f, h_warp - h_weft + 0.4f * (here - 0.5f));
    const float h = Mix(h_weft, h_warp, warp_above);
    const uint32_t id_warp = Hash1(static_cast<uint32_t>(i) * 2u + p.fuzz.seed);
    const uint32_t id_weft = Hash1(static_cast<uint32_t>(j) * 2u + 1u + p.fuzz.seed);
    const float own = Mix(CellRandom(id_weft, 1), CellRandom(id_warp, 1), warp_above) - 0.5f;
    const bool striped = p.stripe_width > 0 && ((i % p.stripe_period + p.stripe_period) %
                                                p.stripe_period) < p.stripe_width;
    const Color& thread = striped ? p.stripe_color : p.warp_color;
    const float ply =
        p.twist * SinTurn(Mix(2.0f * px + 1.5f * py, 1.5f * px + 2.0f * py, warp_above));
    const float gain = (1.0f + p.thread_tone * own) *
                       (1.0f + p.fuzz_tone * fuzz[k] + 0.2f * tone[k]) *
                       (1.0f - p.gap_dark * clear * (1.0f - Clamp01(1.3f * h)));
    out.height[k] = clear * (h + 0.1f * ply) + p.fuzz_relief * fuzz[k];
    out.r[k] = Clamp01(gain * Mix(p.weft_color.r, thread.r, warp_above));
    out.g[k] = Clamp01(gain * Mix(p.weft_color.g, thread.g, warp_above));
    out.b[k] = Clamp01(gain * Mix(p.weft_color.b, thread.b, warp_above));
    out.metal[k] = p.metal;
    out.f0[k] = p.f0;
    out.roughness[k] = p.roughness + p.roughness_spread * (0.5f - h) + 0.08f * fuzz[k];
  }
}

struct Knit {
  Warp warp;
  NoiseOptions fuzz, tone;
  float columns, rows, slant, loop;
  int rib;   // every rib-th column is turned (purl); 0 = none
  int band;  // rows of one colour; 0 = plain
  Color yarn, second;
  float ply, fuzz_relief, gap_dark, roughness, f0;
};

void KnitRow(Knit p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* fuzz = NoiseRow(p.fuzz, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const RowDomain w = Warped(p.warp, d, s);
  for (int k = 0; k < d.n; ++k) {
    const float px = w.x[k] * p.columns;
    const int32_t i = FloorInt(px);
    const float u = px - static_cast<float>(i) - 0.5f;
    const bool turned = p.rib > 0 && ((i % p.rib + p.rib) % p.rib) == 0;
    const float arm = std::fabs(u) - 0.25f;  // each stitch has two slanted arms
    const float py = w.y[k] * p.rows + p.slant * (turned ? -std::fabs(u) : std::fabs(u));
    const int32_t j = FloorInt(py);
    const float v = py - static_cast<float>(j) - 0.5f;
    const float across = Round(4.0f * arm), along = Round(2.0f * v * p.loop);
    const float h = (turned ? 0.7f : 1.0f) * across * (0.35f + 0.65f * along);
    const float ply = SinTurn(3.0f * v + 6.0f * arm * (u > 0.0f ? 1.0f : -1.0f));
    const bool other = p.band > 0 && ((j / p.band) & 1) != 0;
    const Color& c = other ? p.second : p.yarn;
    const float gain = (1.0f - p.gap_dark * (1.0f - Clamp01(1.2f * h))) *
                       (1.0f + 0.3f * fuzz[k] + 0.2f * tone[k] + 0.1f * p.ply * ply);
    out.height[k] = h + 0.12f * p.ply * ply * h + p.fuzz_relief * fuzz[k];
    out.r[k] = Clamp01(c.r * gain);
    out.g[k] = Clamp01(c.g * gain);
    out.b[k] = Clamp01(c.b * gain);
    out.metal[k] = 0.0f;
    out.f0[k] = p.f0;
    out.roughness[k] = p.roughness + 0.1f * (0.5f - h) + 0.05f * fuzz[k];
  }
}

// Layers of streaks at several angles: felt, grass, straw, carbon chips, carpet.
struct Fibres {
  static constexpr int kLayers = 7;
  StreakOptions layers[kLayers];
  NoiseOptions ground, tone;
  Color low, high, other;
  float other_share, relief, shade, roughness, fibre_gloss, f0;
};

void FibresRow(Fibres p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* ground = NoiseRow(p.ground, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  float* profile = s.Row();
  uint32_t* id = s.Ids();
  for (int k = 0; k < d.n; ++k) {
    out.height[k] = 0.3f * ground[k];
    SetColor(out, k, ScaleColor(p.low, p.shade * (1.0f + 0.4f * ground[k])));
    out.roughness[k] = p.roughness;
    out.metal[k] = 0.0f;
    out.f0[k] = p.f0;
  }
  for (int layer = 0; layer < Fibres::kLayers; ++layer) {
    Streaks(p.layers[layer], d.x, d.y, d.n, d.pixel, profile, id);
    const float level = static_cast<float>(layer + 1) / Fibres::kLayers;
    for (int k = 0; k < d.n; ++k) {
      const float cover = Clamp01(2.5f * profile[k]);
      const float t = CellRandom(id[k], 1);
      const bool strange = CellRandom(id[k], 2) < p.other_share;
      const Color& c = strange ? p.other : p.high;
      const float gain =
          Mix(p.shade, 1.0f, level) * (0.7f + 0.3f * profile[k]) * (1.0f + 0.3f * tone[k]);
      out.r[k] = Mix(out.r[k], Clamp01(gain * Mix(p.low.r, c.r, t)), cover);
      out.g[k] = Mix(out.g[k], Clamp01(gain * Mix(p.low.g, c.g, t)), cover);
      out.b[k] = Mix(out.b[k], Clamp01(gain * Mix(p.low.b, c.b, t)), cover);
      out.height[k] =
          std::max(out.height[k], level * p.relief + profile[k] - (cover > 0.0f ? 0.0f : 9.0f));
      out.roughness[k] = Mix(out.roughness[k], p.roughness - p.fibre_gloss * t, cover);
    }
  }
}

}  // namespace

RowFunction DrawWeave(Rng& rng) {
  Weave p;
  p.frequency = rng.LogUniform(8.0f, 70.0f);
  p.aspect = rng.Chance(0.6f) ? 1.0f : rng.LogUniform(0.4f, 2.5f);
  const float kind = rng.Unit();
  p.step = 1;
  p.over = 1;
  p.period = 2;  // plain
  if (kind > 0.4f) {
    p.period = rng.Int(3, 6);  // twill, satin
    p.over = rng.Int(1, p.period - 1);
    if (kind > 0.75f && p.period == 5) p.step = 2;
  }
  p.warp = DrawWarp(rng, 2.0f, 10.0f, rng.Uniform(0.0f, 0.1f));
  p.fuzz = DrawNoise(rng, NoiseKind::kSmooth, 40.0f, 110.0f, 2);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 10.0f, 3);
  p.width = rng.Uniform(0.7f, 1.3f);
  p.sink = rng.Uniform(0.2f, 0.9f);
  p.warp_color = AnyColor(rng);
  p.weft_color = rng.Chance(0.6f) ? Related(rng, p.warp_color, 0.35f) : AnyColor(rng);
  p.stripe_color = AnyColor(rng);
  p.stripe_period = rng.Int(4, 24);
  p.stripe_width = rng.Chance(0.2f) ? rng.Int(1, 6) : 0;
  p.thread_tone = rng.Uniform(0.0f, 0.6f);
  p.gap_dark = rng.Uniform(0.1f, 0.8f);
  p.fuzz_relief = rng.Uniform(0.0f, 0.4f);
  p.fuzz_tone = rng.Uniform(0.0f, 0.4f);
  p.twist = rng.Chance(0.5f) ? rng.Unit() : 0.0f;
  p.roughness = AnyRoughness(rng, rng.Chance(0.25f) ? -0.3f : 0.5f);  // silk or cotton
  p.roughness_spread = rng.Uniform(0.0f, 0.25f);
  p.f0 = AnyDielectricF0(rng);
  p.metal = 0.0f;
  if (rng.Chance(0.1f)) {  // wire mesh
    p.metal = 1.0f;
    p.warp_color = MetalColor(rng);
    p.weft_color = Related(rng, p.warp_color, 0.15f);
    p.stripe_width = 0;
    p.roughness = AnyRoughness(rng, -0.4f);
  }
  return Bind(p, WeaveRow);
}

RowFunction DrawKnit(Rng& rng) {
  Knit p;
  p.columns = rng.LogUniform(5.0f, 26.0f);
  p.rows = p.columns * rng.Uniform(0.9f, 1.8f);
  p.slant = rng.Uniform(0.6f, 1.8f);
  p.loop = rng.Uniform(0.7f, 1.0f);
  p.rib = rng.Chance(0.3f) ? rng.Int(2, 6) : 0;
  p.band = rng.Chance(0.25f) ? rng.Int(1, 6) : 0;
  p.warp = DrawWarp(rng, 2.0f, 8.0f, rng.Uniform(0.0f, 0.08f));
  p.fuzz = DrawNoise(rng, NoiseKind::kSmooth, 40.0f, 110.0f, 2);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 8.0f, 3);
  p.yarn = AnyColor(rng);
  p.second = rng.Chance(0.5f) ? AnyColor(rng) : Related(rng, p.yarn, 0.8f);
  p.ply = rng.Uniform(0.0f, 1.5f);
  p.fuzz_relief = rng.Uniform(0.0f, 0.3f);
  p.gap_dark = rng.Uniform(0.2f, 0.85f);
  p.roughness = AnyRoughness(rng, 0.6f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, KnitRow);
}

RowFunction DrawFibres(Rng& rng) {
  Fibres p;
  const float centre = rng.Unit();
  const float fan = rng.Chance(0.35f) ? rng.Uniform(0.0f, 0.06f) : rng.Uniform(0.1f, 0.5f);
  const float lanes = rng.LogUniform(10.0f, 70.0f);
  const float length = rng.LogUniform(2.0f, 20.0f) / lanes;
  for (StreakOptions& layer : p.layers) {
    layer.angle_turns = centre + fan * rng.Uniform(-1.0f, 1.0f);
    layer.lanes = lanes * rng.Uniform(0.7f, 1.4f);
    layer.length = length * rng.Uniform(0.7f, 1.5f);
    layer.presence = rng.Uniform(0.2f, 0.7f);
    layer.width = rng.Uniform(0.4f, 1.0f);
    layer.bend = rng.Uniform(0.0f, 1.2f);
    layer.seed = rng.Seed();
  }
  p.ground = DrawNoise(rng, NoiseKind::kSmooth, 10.0f, 60.0f, 3);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 8.0f, 3);
  p.high = AnyColor(rng);
  if (rng.Chance(0.25f))
    p.high = FromHsv(rng.Uniform(0.13f, 0.32f), rng.Uniform(0.5f, 0.9f), rng.Uniform(0.08f, 0.4f));
  p.low = ScaleColor(Related(rng, p.high, 0.4f), rng.LogUniform(0.25f, 1.0f));
  p.other = AnyColor(rng);
  p.other_share = rng.Chance(0.4f) ? rng.Uniform(0.0f, 0.3f) : 0.0f;
  p.relief = rng.Uniform(0.0f, 1.5f);
  p.shade = rng.Uniform(0.25f, 1.0f);
  p.roughness = AnyRoughness(rng, 0.4f);
  p.fibre_gloss = rng.Uniform(0.0f, 0.3f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, FibresRow);
}

}  // namespace glint::procedural
