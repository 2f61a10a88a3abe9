#include "datasets/procedural/weathering.h"

#include "datasets/procedural/families/common.h"

namespace glint::procedural {
namespace {

struct Weathering {
  NoiseOptions tone, grain, dirt, gloss, coating, waves;
  StreakOptions scratches[2];
  float tone_strength, tone_tint, grain_tone, grain_relief, grain_roughness;
  float dirt_level, dirt_soft, dirt_strength, gloss_strength, f0_strength, f0_from_tone,
      scratch_gloss, scratch_relief, wave_height;
  Color dirt_color;
};

void AddTone(const Weathering& p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* tone = NoiseRow(p.tone, d, s);
  const float strength = p.tone_strength, tint = p.tone_tint;
  for (int i = 0; i < d.n; ++i) {
    out.r[i] *= 1.0f + (strength + tint) * tone[i];
    out.g[i] *= 1.0f + strength * tone[i];
    out.b[i] *= 1.0f + (strength - tint) * tone[i];
  }
}

void AddGrain(const Weathering& p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* grain = NoiseRow(p.grain, d, s);
  const float gain = p.grain_tone, relief = p.grain_relief, rough = p.grain_roughness;
  for (int i = 0; i < d.n; ++i) {
    out.r[i] *= 1.0f + gain * grain[i];
    out.g[i] *= 1.0f + gain * grain[i];
    out.b[i] *= 1.0f + gain * grain[i];
    out.height[i] += relief * grain[i];
    out.roughness[i] += rough * grain[i];
  }
}

void AddDirt(const Weathering& p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* dirt = NoiseRow(p.dirt, d, s);
  const Color c = p.dirt_color;
  const float level = p.dirt_level, soft = p.dirt_soft, strength = p.dirt_strength;
  for (int i = 0; i < d.n; ++i) {
    const float t = strength * SmoothStep(level, level + soft, dirt[i]);
    out.r[i] = Mix(out.r[i], c.r, t);
    out.g[i] = Mix(out.g[i], c.g, t);
    out.b[i] = Mix(out.b[i], c.b, t);
    out.metal[i] *= 1.0f - t;
    out.roughness[i] = Mix(out.roughness[i], 0.85f, t);
  }
}

void AddGloss(const Weathering& p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* gloss = NoiseRow(p.gloss, d, s);
  for (int i = 0; i < d.n; ++i) out.roughness[i] += p.gloss_strength * gloss[i];
}

// Coatings, moisture and mineral content vary the reflectance of dielectrics from place to place.
void AddCoating(const Weathering& p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* coating = NoiseRow(p.coating, d, s);
  for (int i = 0; i < d.n; ++i) {
    const float tone = 0.3333f * (out.r[i] + out.g[i] + out.b[i]) - 0.25f;
    out.f0[i] += p.f0_strength * coating[i] + p.f0_from_tone * tone;
  }
}

void AddScratches(const Weathering& p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  float* profile = s.Row();
  uint32_t* id = s.Ids();
  for (const StreakOptions& layer : p.scratches) {
    Streaks(layer, d.x, d.y, d.n, d.pixel, profile, id);
    for (int i = 0; i < d.n; ++i) {
      out.roughness[i] += p.scratch_gloss * profile[i];
      out.height[i] -= p.scratch_relief * profile[i];
    }
  }
}

void AddWaves(const Weathering& p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  const float* waves = NoiseRow(p.waves, d, s);
  for (int i = 0; i < d.n; ++i) out.height[i] += p.wave_height * waves[i];
}

void WeatheringRow(Weathering p, const RowDomain& d, Scratch& s, const RowLayers& out) {
  if (p.tone_strength > 0.0f) AddTone(p, d, s, out);
  if (p.grain_tone > 0.0f) AddGrain(p, d, s, out);
  if (p.dirt_strength > 0.0f) AddDirt(p, d, s, out);
  if (p.gloss_strength > 0.0f) AddGloss(p, d, s, out);
  if (p.f0_strength > 0.0f) AddCoating(p, d, s, out);
  if (p.scratch_gloss != 0.0f) AddScratches(p, d, s, out);
  if (p.wave_height > 0.0f) AddWaves(p, d, s, out);
}

}  // namespace

RowFunction DrawWeathering(Rng& rng) {
  Weathering p;
  p.tone = DrawNoise(rng, NoiseKind::kSmooth, 0.8f, 6.0f, 4);
  p.tone_strength = rng.Chance(0.4f) ? rng.Uniform(0.05f, 0.5f) : 0.0f;
  p.tone_tint = rng.Chance(0.5f) ? rng.Uniform(-0.15f, 0.15f) : 0.0f;
  p.grain = DrawNoise(rng, NoiseKind::kSmooth, 60.0f, 130.0f, 2);
  p.grain_tone = rng.Chance(0.5f) ? rng.Uniform(0.02f, 0.3f) : 0.0f;
  p.grain_relief = rng.Uniform(0.0f, 0.03f);
  p.grain_roughness = rng.Uniform(-0.1f, 0.1f);
  p.dirt = DrawNoise(rng, NoiseKind::kSmooth, 1.5f, 15.0f, 5);
  p.dirt_level = rng.Uniform(-0.2f, 0.4f);
  p.dirt_soft = rng.LogUniform(0.05f, 0.6f);
  p.dirt_strength = rng.Chance(0.2f) ? rng.Uniform(0.1f, 0.9f) : 0.0f;
  p.dirt_color = rng.Chance(0.5f) ? EarthColor(rng) : GreyColor(rng);
  p.gloss = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 20.0f, 4);
  p.gloss_strength = rng.Chance(0.35f) ? rng.Uniform(0.03f, 0.35f) : 0.0f;
  p.coating = DrawNoise(rng, NoiseKind::kSmooth, 1.0f, 20.0f, 3);
  p.f0_strength = rng.Chance(0.35f) ? rng.Uniform(0.001f, 0.04f) : 0.0f;
  p.f0_from_tone = rng.Chance(0.6f) ? rng.Uniform(-0.08f, 0.08f) : 0.0f;
  for (StreakOptions& layer : p.scratches) {
    layer.angle_turns = rng.Unit();
    layer.lanes = rng.LogUniform(10.0f, 40.0f);
    layer.length = rng.LogUniform(0.1f, 0.8f);
    layer.presence = rng.LogUniform(0.03f, 0.3f);
    layer.width = rng.Uniform(0.5f, 1.5f) * layer.lanes / 256.0f;
    layer.bend = rng.Uniform(0.0f, 0.8f);
    layer.seed = rng.Seed();
  }
  p.scratch_gloss = rng.Chance(0.12f) ? rng.Uniform(-0.15f, 0.35f) : 0.0f;
  p.scratch_relief = rng.Uniform(0.0f, 0.05f);
  p.waves = DrawNoise(rng, NoiseKind::kSmooth, 0.8f, 4.0f, 2);
  p.wave_height = rng.Chance(0.15f) ? rng.LogUniform(0.3f, 3.0f) : 0.0f;
  return Bind(p, WeatheringRow);
}

}  // namespace glint::procedural
