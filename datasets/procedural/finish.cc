#include "datasets/procedural/finish.h"

#include <algorithm>
#include <cmath>

#include "base/cpu/vector_clones.h"
#include "datasets/procedural/detail.h"
#include "datasets/procedural/palette.h"
#include "datasets/procedural/random.h"
#include "datasets/procedural/shaping.h"

namespace glint::procedural {
namespace {

// How the roughness follows the tone of the detail.
enum class Coupling { kAgainst, kWith, kOwn, kNone };

struct Finish {
  // Contrast of what the family drew, about its mean; chroma: of its colour alone.
  float tone_contrast = 1, chroma_contrast = 1, rough_contrast = 1;
  DetailOptions detail, second;
  float cavity_radius = 0;  // of the blur that tells crevices from ridges, in units
  float cavity_share = 0;   // of the crevices in the tone, the rest being detail
  float brightness = 1;     // of dielectrics' colours
  float saturation = 1;     // of all colours
  float gloss = 1;          // factor of the roughness
  float f0 = 1;             // factor of the dielectric F0: the tail of stones and coatings
  float tone = 0;           // relative change of colour
  Coupling coupling = Coupling::kNone;
  float rough = 0;         // change of roughness
  float rough_slopes = 0;  // roughness that a slope of 1 adds
  float relief = 0;        // detail in the height, in units; negative: dark stands out
  float skew = 0;          // of the detail: specks that are lighter or darker than the rest
  float dirt = 0, dirt_level = 0, dirt_soft = 1;
  Color dirt_color;
  float dirt_rough = 0.85f;  // wet when low
  float wear = 0, wear_level = 0, wear_gain = 1, wear_gloss = 0;
  float bare = 0;  // of the worn ridges shows metal
  Color bare_color;
};

DetailOptions DrawDetail(Rng& rng) {
  DetailOptions o;
  o.gain = rng.Uniform(1.0f, 2.1f);
  o.coarsest = rng.Int(3, 6);
  const int stretch = rng.Chance(0.4f) ? rng.Int(1, 4) : 0;
  (rng.Chance(0.5f) ? o.stretch_x : o.stretch_y) = stretch;
  o.seed = rng.Seed();
  return o;
}

Coupling DrawCoupling(Rng& rng) {
  const float kind = rng.Unit();
  if (kind < 0.58f) return Coupling::kAgainst;
  if (kind < 0.7f) return Coupling::kWith;
  return kind < 0.85f ? Coupling::kOwn : Coupling::kNone;
}

void DrawDirtAndWear(Rng& rng, Finish* p) {
  const bool wet = rng.Chance(0.25f);
  const bool dirty = rng.Chance(0.22f), worn = rng.Chance(0.25f);
  p->dirt = dirty ? rng.Uniform(0.2f, 0.95f) : 0.0f;
  p->dirt_level = rng.Uniform(-0.2f, 1.2f);
  p->dirt_soft = rng.LogUniform(0.25f, 1.8f);
  p->dirt_color = ScaleColor(rng.Chance(0.6f) ? EarthColor(rng) : GreyColor(rng), 0.5f);
  p->dirt_rough = wet ? rng.Uniform(0.08f, 0.3f) : rng.Uniform(0.6f, 0.95f);
  p->wear = worn ? rng.Uniform(0.2f, 0.95f) : 0.0f;
  p->wear_level = rng.Uniform(0.0f, 1.4f);
  p->wear_gain = rng.LogUniform(0.8f, 2.2f);
  p->wear_gloss = rng.Uniform(-0.1f, 0.3f);
  p->bare = rng.Chance(0.15f) ? 1.0f : 0.0f;
  p->bare_color = MetalColor(rng);
}

Finish DrawFinish(uint64_t seed) {
  Rng rng(seed);
  Finish p;
  if (rng.Chance(0.9f)) p.tone_contrast = rng.Uniform(0.05f, 0.55f);
  if (rng.Chance(0.9f)) p.chroma_contrast = rng.Uniform(0.05f, 0.7f);
  if (rng.Chance(0.9f)) p.rough_contrast = rng.Uniform(0.02f, 0.4f);
  p.brightness = rng.LogUniform(0.75f, 1.8f);
  p.saturation = rng.Uniform(0.9f, 1.7f);
  p.gloss = rng.LogUniform(0.62f, 1.14f);
  p.f0 = rng.Chance(0.08f) ? rng.LogUniform(1.2f, 3.5f) : 1.0f;
  p.detail = DrawDetail(rng);
  p.second = DrawDetail(rng);
  p.cavity_radius = rng.LogUniform(1.5f, 14.0f) / 256.0f;
  p.cavity_share = rng.Unit();
  p.tone = rng.Chance(0.95f) ? rng.LogUniform(0.06f, 0.5f) : 0.0f;
  p.coupling = DrawCoupling(rng);
  p.rough = rng.LogUniform(0.006f, 0.08f);
  p.rough_slopes = rng.Chance(0.5f) ? rng.Uniform(0.0f, 0.2f) : 0.0f;
  p.relief = rng.Chance(0.7f) ? rng.LogUniform(0.05f, 0.7f) / 256.0f : 0.0f;
  if (rng.Chance(0.3f)) p.relief = -p.relief;
  p.skew = rng.Chance(0.6f) ? rng.Uniform(-0.35f, 0.55f) : 0.0f;
  DrawDirtAndWear(rng, &p);
  return p;
}

float MeanOf(const Plane& plane) {
  double sum = 0.0;
  for (const float value : plane) sum += value;
  return static_cast<float>(sum / static_cast<double>(plane.size()));
}

// Contrast about the mean colour, of lightness and of chroma apart.
GLINT_VECTOR_CLONES
void CalmColors(const Finish& p, size_t n, Color mean, float* __restrict r, float* __restrict g,
                float* __restrict b) {
  const float tone = p.tone_contrast, chroma = p.chroma_contrast;
  const float level = std::max(mean.r + mean.g + mean.b, 1e-3f);
  const float grey = (1.0f - p.saturation) / 3.0f, own = p.saturation;
  const Color hue = {mean.r / level, mean.g / level, mean.b / level};
  for (size_t i = 0; i < n; ++i) {
    const float sum = r[i] + g[i] + b[i];
    const float calm = level + tone * (sum - level);
    const float gain = own * chroma * calm / std::max(sum, 1e-4f);
    const float rest = own * (1.0f - chroma) * calm, shared = grey * calm;
    r[i] = std::max(shared + rest * hue.r + gain * r[i], 0.003f);
    g[i] = std::max(shared + rest * hue.g + gain * g[i], 0.003f);
    b[i] = std::max(shared + rest * hue.b + gain * b[i], 0.003f);
  }
}

void Calm(const Finish& p, LayerPlanes* planes) {
  const Color mean = {MeanOf(planes->r), MeanOf(planes->g), MeanOf(planes->b)};
  CalmColors(p, planes->r.size(), mean, planes->r.data(), planes->g.data(), planes->b.data());
  for (float& value : planes->f0) value *= p.f0;
  const float rough = MeanOf(planes->roughness);
  for (float& value : planes->roughness)
    value = p.gloss * (rough + p.rough_contrast * (value - rough));
}

// Height less its surroundings, over its own spread and softly bounded: about −2 in crevices,
// 2 on ridges.
Plane CavityOf(LayerPlanes* planes, float radius) {
  const int width = planes->width, height = planes->height;
  const float longer = static_cast<float>(std::max(width, height));
  const int texels = std::max(static_cast<int>(std::lround(radius * longer)), 1);
  Plane out = Blurred(planes->HeightRow(0), width, height, planes->height_stride(), texels);
  double square = 0.0;
  for (int y = 0; y < height; ++y) {
    const float* from = planes->HeightRow(y);
    float* to = out.data() + static_cast<size_t>(y) * width;
    float row = 0.0f;
    for (int i = 0; i < width; ++i) {
      to[i] = from[i] - to[i];
      row += to[i] * to[i];
    }
    square += row;
  }
  const float rms = static_cast<float>(std::sqrt(square / static_cast<double>(out.size())));
  // A flat surface has no crevices: let numerical dust not become any.
  const float scale = 1.0f / std::max(rms, 2e-6f);
  for (float& value : out) value = scale * value / (1.0f + 0.3f * std::fabs(scale * value));
  return out;
}

// Albedo bent over toward 1 from .6 on.
inline float Bounded(float x) {
  const float over = std::max(x - 0.6f, 0.0f);
  return std::min(x, 0.6f) + over / (1.0f + 2.5f * over);
}

GLINT_VECTOR_CLONES
void FinishTexels(Finish p, const float* details, const float* second, const float* cavities, int n,
                  float* __restrict r, float* __restrict g, float* __restrict b,
                  float* __restrict metal, float* __restrict roughness) {
  const float rough_by_tone = p.coupling == Coupling::kAgainst ? -p.rough
                              : p.coupling == Coupling::kWith  ? p.rough
                                                               : 0.0f;
  const float rough_by_own = p.coupling == Coupling::kOwn ? p.rough : 0.0f;
  const float dirt_end = p.dirt_level + p.dirt_soft;
  for (int i = 0; i < n; ++i) {
    const float cavity = cavities[i];
    const float tone = Mix(details[i], cavity, p.cavity_share);
    const float gain =
        std::min(std::max(1.0f + p.tone * (1.0f - 0.6f * metal[i]) * tone, 0.2f), 2.5f);
    const float worn =
        p.wear * SmoothStep(p.wear_level, p.wear_level + 0.6f, cavity + 0.5f * second[i]);
    const float dirt = p.dirt * SmoothStep(p.dirt_level, dirt_end, -cavity + 0.4f * second[i]);
    const float light = gain * Mix(1.0f, p.wear_gain, worn) * Mix(p.brightness, 1.0f, metal[i]);
    const float bare = p.bare * worn;
    const float rough = roughness[i] + rough_by_tone * tone +
                        rough_by_own * second[i] * (1.0f + 0.4f * second[i]) - p.wear_gloss * worn;
    r[i] = Mix(Mix(Bounded(r[i] * light), p.bare_color.r, bare), p.dirt_color.r, dirt);
    g[i] = Mix(Mix(Bounded(g[i] * light), p.bare_color.g, bare), p.dirt_color.g, dirt);
    b[i] = Mix(Mix(Bounded(b[i] * light), p.bare_color.b, bare), p.dirt_color.b, dirt);
    metal[i] = Mix(metal[i], 1.0f, bare) * (1.0f - dirt);
    roughness[i] = Mix(rough, p.dirt_rough, dirt);
  }
}

// The detail as it is seen: specks stand out from the rest.
void Skew(float skew, Plane* detail) {
  for (float& value : *detail) value += skew * (value * value - 1.0f);
}

// Adds detail to the heights; on the border as the two texels inside go on.
void AddRelief(float relief, const Plane& detail, LayerPlanes* planes) {
  const int width = planes->width, height = planes->height;
  const auto at = [&](int x, int y) {
    return detail[static_cast<size_t>(std::clamp(y, 0, height - 1)) * width +
                  std::clamp(x, 0, width - 1)];
  };
  const auto beyond = [&](int x, int y, int dx, int dy) {
    return 2.0f * at(x + dx, y + dy) - at(x + 2 * dx, y + 2 * dy);
  };
  for (int y = 0; y < height; ++y) {
    float* to = planes->HeightRow(y);
    for (int x = 0; x < width; ++x) to[x] += relief * detail[static_cast<size_t>(y) * width + x];
    to[-1] += relief * beyond(-1, y, 1, 0);
    to[width] += relief * beyond(width, y, -1, 0);
  }
  for (int x = 0; x < width; ++x) {
    planes->HeightRow(-1)[x] += relief * beyond(x, -1, 0, 1);
    planes->HeightRow(height)[x] += relief * beyond(x, height, 0, -1);
  }
}

// Texels on slopes gather what their normals leave out: steeper is rougher.
GLINT_VECTOR_CLONES
void RoughenRow(const float* height, ptrdiff_t stride, float strength, float per_texel, int n,
                float* __restrict roughness) {
  for (int i = 0; i < n; ++i) {
    const float x = per_texel * (height[i + 1] - height[i - 1]);
    const float y = per_texel * (height[i + stride] - height[i - stride]);
    roughness[i] += strength * std::min(std::sqrt(x * x + y * y), 1.5f);
  }
}

void RoughenSlopes(float strength, LayerPlanes* planes) {
  const float per_texel = 0.5f * static_cast<float>(std::max(planes->width, planes->height));
  for (int y = 0; y < planes->height; ++y) {
    RoughenRow(planes->HeightRow(y), planes->height_stride(), strength, per_texel, planes->width,
               planes->roughness.data() + static_cast<size_t>(y) * planes->width);
  }
}

}  // namespace

LayerPlanes::LayerPlanes(int width_in, int height_in)
    : width(width_in),
      height(height_in),
      heights(static_cast<size_t>(width_in + 2) * (height_in + 2)),
      r(static_cast<size_t>(width_in) * height_in),
      g(r.size()),
      b(r.size()),
      metal(r.size()),
      f0(r.size()),
      roughness(r.size()) {}

PatternScale FinishScale(uint64_t seed) {
  Rng rng(~seed);
  const float zoom = rng.LogUniform(0.8f, 4.5f);
  const float stretch = rng.Chance(0.6f) ? rng.LogUniform(0.4f, 2.5f) : 1.0f;
  // Some are all but flat, and a few rugged: the tail of steep normals.
  const float kind = rng.Unit();
  const float relief = kind < 0.2f    ? rng.Uniform(0.1f, 0.5f)
                       : kind < 0.92f ? rng.Uniform(0.7f, 1.0f)
                                      : rng.Uniform(1.5f, 3.0f);
  return {zoom * std::sqrt(stretch), zoom / std::sqrt(stretch), relief};
}

void FinishSurface(uint64_t seed, float slope, LayerPlanes* planes) {
  Finish p = DrawFinish(seed);
  p.relief *= slope;
  Calm(p, planes);
  const int width = planes->width, height = planes->height;
  const Plane cavity = CavityOf(planes, p.cavity_radius);
  Plane detail = DetailNoise(p.detail, width, height);
  Skew(p.skew, &detail);
  const Plane second = DetailNoise(p.second, width, height);
  FinishTexels(p, detail.data(), second.data(), cavity.data(), width * height, planes->r.data(),
               planes->g.data(), planes->b.data(), planes->metal.data(), planes->roughness.data());
  if (p.relief != 0.0f) AddRelief(p.relief, detail, planes);
  if (p.rough_slopes > 0.0f) RoughenSlopes(p.rough_slopes, planes);
}

}  // namespace glint::procedural
