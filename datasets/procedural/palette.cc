#include "datasets/procedural/palette.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/procedural/shaping.h"

namespace glint::procedural {
namespace {

constexpr float kDarkest = 0.004f;
constexpr float kBrightest = 0.93f;

Color Bound(Color c) {
  const auto bound = [](float v) { return std::clamp(v, kDarkest, kBrightest); };
  return {bound(c.r), bound(c.g), bound(c.b)};
}

}  // namespace

Color FromHsv(float hue, float saturation, float value) {
  const auto channel = [&](float offset) {
    const float k = Fract(hue + offset) * 6.0f;
    const float w = Clamp01(std::fabs(k - 3.0f) - 1.0f);
    return value * Mix(1.0f, w, saturation);
  };
  return {channel(0.0f), channel(2.0f / 3.0f), channel(1.0f / 3.0f)};
}

Color MixColors(const Color& a, const Color& b, float t) {
  return {Mix(a.r, b.r, t), Mix(a.g, b.g, t), Mix(a.b, b.b, t)};
}

Color ScaleColor(const Color& c, float gain) { return Bound({c.r * gain, c.g * gain, c.b * gain}); }

Color GreyColor(Rng& rng) {
  const float hue = rng.Uniform(0.02f, 0.7f);
  const float saturation = rng.Uniform(0.0f, 0.25f);
  return Bound(FromHsv(hue, saturation, rng.LogUniform(0.03f, 0.85f)));
}

Color EarthColor(Rng& rng) {
  const float hue = rng.Uniform(0.01f, 0.14f);
  const float saturation = rng.Uniform(0.25f, 0.85f);
  return Bound(FromHsv(hue, saturation, rng.LogUniform(0.04f, 0.6f)));
}

Color WoodColor(Rng& rng) {
  if (rng.Chance(0.08f)) return AnyColor(rng);  // stained or painted
  const float lightness = rng.Unit();
  const float hue = rng.Uniform(0.03f, 0.1f);
  const float saturation = Mix(rng.Uniform(0.6f, 0.95f), rng.Uniform(0.35f, 0.75f), lightness);
  return Bound(FromHsv(hue, saturation, 0.025f * std::pow(30.0f, lightness)));
}

Color SaturatedColor(Rng& rng) {
  const float hue = rng.Unit();
  const float saturation = rng.Uniform(0.65f, 1.0f);
  return Bound(FromHsv(hue, saturation, rng.LogUniform(0.03f, 0.85f)));
}

Color RustColor(Rng& rng) {
  const float hue = rng.Uniform(0.02f, 0.075f);
  const float saturation = rng.Uniform(0.65f, 0.95f);
  return Bound(FromHsv(hue, saturation, rng.LogUniform(0.06f, 0.4f)));
}

Color AnyColor(Rng& rng) {
  const float kind = rng.Unit();
  if (kind < 0.22f) return GreyColor(rng);
  if (kind < 0.45f) return EarthColor(rng);
  if (kind < 0.70f) return SaturatedColor(rng);
  const float hue = rng.Unit();
  const float mixed = rng.Unit();
  if (kind < 0.80f) return Bound(FromHsv(hue, 0.05f + 0.35f * mixed, rng.Uniform(0.4f, 0.9f)));
  if (kind < 0.90f) return Bound(FromHsv(hue, 0.8f * mixed, rng.LogUniform(0.004f, 0.04f)));
  if (kind < 0.95f) return Bound(FromHsv(hue, 0.08f * mixed, rng.Uniform(0.75f, 0.93f)));
  return Bound(FromHsv(hue, 0.2f + 0.5f * mixed, rng.LogUniform(0.05f, 0.6f)));
}

Color MetalColor(Rng& rng) {
  // Iron, aluminium, gold, copper, brass, titanium, chromium, nickel, bronze.
  static constexpr std::array<Color, 9> kMetals = {{{0.56f, 0.57f, 0.58f},
                                                    {0.91f, 0.92f, 0.92f},
                                                    {1.00f, 0.77f, 0.34f},
                                                    {0.95f, 0.64f, 0.54f},
                                                    {0.91f, 0.78f, 0.42f},
                                                    {0.54f, 0.50f, 0.45f},
                                                    {0.55f, 0.56f, 0.55f},
                                                    {0.66f, 0.61f, 0.53f},
                                                    {0.71f, 0.54f, 0.34f}}};
  Color c = kMetals[static_cast<size_t>(rng.Int(0, 8))];
  const Color tint = FromHsv(rng.Unit(), rng.Uniform(0.0f, 0.6f), 1.0f);  // anodised, heat-tinted
  if (rng.Chance(0.2f)) c = {c.r * tint.r, c.g * tint.g, c.b * tint.b};
  const float gain = rng.Uniform(0.8f, 1.08f);
  const float grey = rng.Uniform(0.0f, 0.3f);
  const float mean = (c.r + c.g + c.b) / 3.0f;
  const auto finish = [&](float v) { return std::clamp(gain * Mix(v, mean, grey), 0.2f, 0.98f); };
  return {finish(c.r), finish(c.g), finish(c.b)};
}

Color Related(Rng& rng, const Color& c, float spread) {
  const float gain = std::exp(rng.Uniform(-1.0f, 1.0f) * spread);
  const float tint = 0.35f * spread;
  const float red = 1.0f + tint * rng.Uniform(-1.0f, 1.0f);
  const float green = 1.0f + 0.6f * tint * rng.Uniform(-1.0f, 1.0f);
  const float blue = 1.0f + tint * rng.Uniform(-1.0f, 1.0f);
  return Bound({c.r * gain * red, c.g * gain * green, c.b * gain * blue});
}

float AnyRoughness(Rng& rng, float bias) {
  const float t = rng.Unit();
  const float centre = 0.5f + 0.4f * bias + 0.75f * (t - 0.5f);
  const float spread = rng.Uniform(-0.12f, 0.12f);
  if (rng.Chance(0.1f)) return rng.Uniform(0.06f, 1.0f);
  return std::clamp(centre + spread, 0.06f, 0.98f);
}

float AnyDielectricF0(Rng& rng) {
  const float common = rng.Uniform(0.035f, 0.05f);
  const float wide = rng.Uniform(0.02f, 0.08f);
  return rng.Chance(0.6f) ? common : wide;
}

}  // namespace glint::procedural
