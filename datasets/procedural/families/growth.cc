// What lies and grows on the ground in layers of single things: grass, leaves, chips, moss.
#include "datasets/procedural/families/common.h"
#include "datasets/procedural/families/families.h"
#include "datasets/procedural/scatter.h"

namespace glint::procedural {
namespace {

constexpr int kColors = 4;

// Layers of like things, one upon the other.
struct Layers {
  static constexpr int kMost = 3;
  int count;
  ScatterOptions layer[kMost];
  NoiseOptions ground, tone, fibre;
  Color colors[kColors], soil;
  float thickness, curl, vein, vein_tone, id_tone, shade, fibre_strength, round;
  float roughness, soil_roughness, id_gloss, f0;
};

void LayersRow(Layers p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* ground = NoiseRow(p.ground, d, s);
  const float* tone = NoiseRow(p.tone, d, s);
  const ScatterRows thing = TakeScatterRows(s);
  RowDomain along{thing.u, thing.v, d.n, d.pixel * p.layer[0].frequency};
  float* fibre = s.Row();
  for (int i = 0; i < d.n; ++i) {
    const float gain = 1.0f + 0.5f * ground[i];
    out.height[i] = 0.5f * ground[i];
    out.r[i] = p.soil.r * gain;
    out.g[i] = p.soil.g * gain;
    out.b[i] = p.soil.b * gain;
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = p.soil_roughness;
  }
  for (int k = 0; k < p.count; ++k) {
    ScatterThings(p.layer[k], d.x, d.y, d.n, d.pixel, thing);
    if (p.fibre_strength > 0.0f) {
      FractalNoise(p.fibre, along.x, along.y, d.n, along.pixel, fibre);
    } else {
      SetAll(fibre, d.n, 0.0f);
    }
    const float lift = static_cast<float>(k + 1) / static_cast<float>(p.count);
    const float soft = EdgeWidth(0.05f, p.layer[k].frequency / p.layer[k].half_width, d.pixel);
    const float per_soft = 1.0f / soft;
    const float light = Mix(1.0f - p.shade, 1.0f, lift);
    for (int i = 0; i < d.n; ++i) {
      const uint32_t id = thing.id[i];
      const float cover = Clamp01(thing.inset[i] * per_soft);
      const float vein = p.vein * std::max(1.0f - 8.0f * std::fabs(thing.v[i]), 0.0f);
      const float form = p.round * Clamp01(thing.inset[i]) +
                         p.curl * (CellRandom(id, 1) - 0.4f) * thing.u[i] * thing.u[i] +
                         0.3f * (CellRandom(id, 2) - 0.5f) * thing.v[i] - 0.3f * vein;
      const Color& c = p.colors[static_cast<int>(3.999f * CellRandom(id, 3))];
      const float gain = light * (1.0f + p.id_tone * (CellRandom(id, 4) - 0.5f)) *
                         (1.0f + 0.3f * tone[i] + p.vein_tone * vein) *
                         (1.0f + p.fibre_strength * fibre[i]);
      out.height[i] = Mix(out.height[i],
                          p.thickness * (lift + form) + 0.1f * p.fibre_strength * fibre[i], cover);
      out.r[i] = Mix(out.r[i], Clamp01(c.r * gain), cover);
      out.g[i] = Mix(out.g[i], Clamp01(c.g * gain), cover);
      out.b[i] = Mix(out.b[i], Clamp01(c.b * gain), cover);
      out.roughness[i] = Mix(out.roughness[i],
                             p.roughness + p.id_gloss * (CellRandom(id, 5) - 0.5f) +
                                 0.1f * p.fibre_strength * fibre[i],
                             cover);
    }
  }
}

// Everything that the four families below set otherwise.
Layers LayersParameters(Rng& rng) {
  Layers p;
  p.count = 3;
  for (ScatterOptions& layer : p.layer) layer.seed = rng.Seed();
  p.ground = DrawNoise(rng, NoiseKind::kSmooth, 15.0f, 60.0f, 4);
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 8.0f, 3);
  p.fibre = DrawNoise(rng, NoiseKind::kSmooth, 0.6f, 1.5f, 3);
  p.fibre.stretch = rng.Uniform(6.0f, 14.0f);
  p.soil = ScaleColor(EarthColor(rng), 0.4f);
  p.thickness = rng.Uniform(0.3f, 1.0f);
  p.curl = rng.Uniform(0.0f, 0.6f);
  p.vein = p.vein_tone = p.fibre_strength = 0.0f;
  p.id_tone = rng.Uniform(0.3f, 1.0f);
  p.shade = rng.Uniform(0.2f, 0.8f);
  p.round = rng.Uniform(0.0f, 0.4f);
  p.roughness = AnyRoughness(rng, 0.2f);
  p.soil_roughness = rng.Uniform(0.7f, 0.98f);
  p.id_gloss = rng.Uniform(0.0f, 0.3f);
  p.f0 = AnyDielectricF0(rng);
  return p;
}

void DrawSizes(Rng& rng, Layers* p, float frequency, float half_length, float half_width) {
  for (ScatterOptions& layer : p->layer) {
    layer.frequency = frequency * rng.Uniform(0.75f, 1.3f);
    layer.half_length = half_length;
    layer.half_width = half_width;
  }
}

// Clumps over stone or soil, where the ground is low or high.
struct Moss {
  Warp warp;
  NoiseOptions relief, extent, clumps, fine;
  Scheme stone, moss;
  float level, soft, by_height, height, roughness, stone_roughness, f0;
};

void MossRow(Moss p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const RowDomain w = Warped(p.warp, d, s);
  const float* relief = NoiseRow(p.relief, w, s);
  const float* extent = NoiseRow(p.extent, w, s);
  const float* clumps = NoiseRow(p.clumps, d, s);
  const float* fine = NoiseRow(p.fine, d, s);
  for (int i = 0; i < d.n; ++i) {
    const float field = extent[i] + p.by_height * relief[i] + 0.25f * clumps[i] + 0.15f * fine[i];
    const float moss = SmoothStep(p.level, p.level + p.soft, field);
    const float rise = moss * (0.5f + clumps[i] + 0.4f * fine[i]);
    const float t = Clamp01(0.5f + 0.6f * relief[i]);
    const float q = Clamp01(clumps[i] + 0.4f * fine[i]);
    const float dark = 0.7f + 0.3f * t + 0.1f * fine[i], lit = 0.3f + 0.9f * q;
    out.height[i] = relief[i] + p.height * rise;
    out.r[i] = Mix(dark * Mix(p.stone.base.r, p.stone.second.r, t),
                   lit * Mix(p.moss.base.r, p.moss.second.r, q), moss);
    out.g[i] = Mix(dark * Mix(p.stone.base.g, p.stone.second.g, t),
                   lit * Mix(p.moss.base.g, p.moss.second.g, q), moss);
    out.b[i] = Mix(dark * Mix(p.stone.base.b, p.stone.second.b, t),
                   lit * Mix(p.moss.base.b, p.moss.second.b, q), moss);
    out.metal[i] = 0.0f;
    out.f0[i] = p.f0;
    out.roughness[i] = Mix(p.stone_roughness - 0.2f * t, p.roughness - 0.1f * q, moss);
  }
}

Color LeafColor(Rng& rng) {
  return FromHsv(rng.Uniform(0.12f, 0.36f), rng.Uniform(0.4f, 0.9f), rng.LogUniform(0.04f, 0.45f));
}

}  // namespace

RowFunction DrawGrass(Rng& rng) {
  Layers p = LayersParameters(rng);
  const float spread = rng.Chance(0.5f) ? 1.0f : rng.Uniform(0.1f, 0.4f), turn = rng.Unit();
  DrawSizes(rng, &p, rng.LogUniform(3.0f, 9.0f), 1.0f, rng.LogUniform(0.08f, 0.25f));
  for (ScatterOptions& layer : p.layer) {
    layer.angle_turns = turn;
    layer.angle_spread = spread;
  }
  const Color fresh = rng.Chance(0.75f) ? LeafColor(rng) : EarthColor(rng);
  for (Color& c : p.colors) c = Related(rng, fresh, 0.5f);
  if (rng.Chance(0.5f)) p.colors[3] = EarthColor(rng);  // dry blades
  p.vein = rng.Uniform(0.0f, 0.6f);
  p.round = rng.Uniform(0.2f, 0.6f);
  return Bind(p, LayersRow);
}

RowFunction DrawLitter(Rng& rng) {
  Layers p = LayersParameters(rng);
  p.count = rng.Int(1, 3);
  DrawSizes(rng, &p, rng.LogUniform(3.0f, 14.0f), rng.Uniform(0.6f, 0.95f),
            rng.Uniform(0.15f, 0.5f));
  for (ScatterOptions& layer : p.layer) layer.presence = rng.Uniform(0.2f, 1.0f);
  for (Color& c : p.colors) c = rng.Chance(0.7f) ? EarthColor(rng) : LeafColor(rng);
  p.vein = rng.Uniform(0.3f, 1.0f);
  p.vein_tone = rng.Uniform(-0.4f, 0.8f);
  return Bind(p, LayersRow);
}

RowFunction DrawChipboard(Rng& rng) {
  Layers p = LayersParameters(rng);
  DrawSizes(rng, &p, rng.LogUniform(4.0f, 20.0f), 0.98f, rng.Uniform(0.2f, 0.6f));
  for (ScatterOptions& layer : p.layer) layer.square = rng.Uniform(0.6f, 1.0f);
  const Color wood = WoodColor(rng);
  for (Color& c : p.colors) c = Related(rng, wood, 0.4f);
  p.soil = Related(rng, wood, 0.6f);
  p.fibre_strength = rng.Uniform(0.2f, 0.7f);
  p.shade = rng.Uniform(0.0f, 0.4f);
  p.id_tone = rng.Uniform(0.1f, 0.6f);
  p.curl = rng.Uniform(0.0f, 0.1f);
  return Bind(p, LayersRow);
}

RowFunction DrawImpasto(Rng& rng) {
  Layers p = LayersParameters(rng);
  DrawSizes(rng, &p, rng.LogUniform(3.0f, 12.0f), 1.0f, rng.Uniform(0.15f, 0.5f));
  const float turn = rng.Unit(), spread = rng.Chance(0.5f) ? 1.0f : rng.Uniform(0.05f, 0.3f);
  for (ScatterOptions& layer : p.layer) {
    layer.square = rng.Unit();
    layer.angle_turns = turn;
    layer.angle_spread = spread;
  }
  const Color first = AnyColor(rng);
  for (Color& c : p.colors) c = rng.Chance(0.6f) ? Related(rng, first, 0.6f) : AnyColor(rng);
  p.soil = Related(rng, first, 0.5f);
  p.fibre_strength = rng.Uniform(0.1f, 0.5f);
  p.shade = 0.0f;
  p.roughness = AnyRoughness(rng, -0.3f);
  p.soil_roughness = p.roughness;
  return Bind(p, LayersRow);
}

RowFunction DrawMoss(Rng& rng) {
  Moss p;
  p.warp = DrawWarp(rng, 2.0f, 10.0f, rng.Uniform(0.0f, 0.4f));
  p.relief =
      DrawNoise(rng, rng.Chance(0.5f) ? NoiseKind::kSmooth : NoiseKind::kRidged, 2.0f, 15.0f, 5);
  p.extent = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 8.0f, 4);
  p.clumps = DrawNoise(rng, NoiseKind::kBillow, 10.0f, 45.0f, 3);
  p.fine = DrawNoise(rng, NoiseKind::kSmooth, 50.0f, 90.0f, 2);
  p.stone = DrawScheme(
      rng, [](Rng& r) { return r.Chance(0.7f) ? GreyColor(r) : EarthColor(r); }, 0.6f);
  p.moss = DrawScheme(rng, LeafColor, 0.6f);
  p.level = rng.Uniform(-0.5f, 0.4f);
  p.soft = rng.LogUniform(0.05f, 0.5f);
  p.by_height = rng.Uniform(-0.8f, 0.8f);
  p.height = rng.Uniform(0.1f, 0.8f);
  p.roughness = rng.Uniform(0.75f, 1.0f);
  p.stone_roughness = AnyRoughness(rng, 0.3f);
  p.f0 = AnyDielectricF0(rng);
  return Bind(p, MossRow);
}

}  // namespace glint::procedural
