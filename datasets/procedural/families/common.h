// Helpers that the families share.
#pragma once

#include <algorithm>

#include "datasets/procedural/layers.h"
#include "datasets/procedural/noise.h"
#include "datasets/procedural/palette.h"
#include "datasets/procedural/patterns.h"
#include "datasets/procedural/random.h"
#include "datasets/procedural/shaping.h"

namespace glint::procedural {

// A row function over parameters held by value: locals that no store can alias, so loops vectorise.
template <typename Parameters>
RowFunction Bind(Parameters p,
                 void (*row)(Parameters, const RowDomain&, Scratch&, const RowLayers&)) {
  return [p, row](const RowDomain& d, Scratch& s, const RowLayers& out) { row(p, d, s, out); };
}

inline NoiseOptions DrawNoise(Rng& rng, NoiseKind kind, float low, float high, int octaves) {
  NoiseOptions o;
  o.kind = kind;
  o.frequency = rng.LogUniform(low, high);
  o.octaves = octaves;
  o.gain = rng.Uniform(0.38f, 0.66f);
  o.seed = rng.Seed();
  return o;
}

inline float* NoiseRow(const NoiseOptions& options, const RowDomain& d, Scratch& scratch) {
  float* out = scratch.Row();
  FractalNoise(options, d.x, d.y, d.n, d.pixel, out);
  return out;
}

// Bends straight patterns: points moved by `amount` times smooth noise.
struct Warp {
  NoiseOptions noise;
  float amount = 0.0f;
};

inline Warp DrawWarp(Rng& rng, float frequency_low, float frequency_high, float cells_moved) {
  Warp w;
  w.noise = DrawNoise(rng, NoiseKind::kSmooth, frequency_low, frequency_high, 2);
  w.amount = cells_moved / w.noise.frequency;
  return w;
}

inline RowDomain Warped(const Warp& warp, const RowDomain& d, Scratch& scratch) {
  if (warp.amount == 0.0f) return d;
  float* x = NoiseRow(warp.noise, d, scratch);
  NoiseOptions second = warp.noise;
  second.seed ^= 0x68bc21ebu;
  float* y = NoiseRow(second, d, scratch);
  for (int i = 0; i < d.n; ++i) {
    x[i] = d.x[i] + warp.amount * x[i];
    y[i] = d.y[i] + warp.amount * y[i];
  }
  return {x, y, d.n, d.pixel};
}

inline RowDomain Stretched(const RowDomain& d, float sx, float sy, Scratch& scratch) {
  float* x = scratch.Row();
  float* y = scratch.Row();
  for (int i = 0; i < d.n; ++i) {
    x[i] = d.x[i] * sx;
    y[i] = d.y[i] * sy;
  }
  return {x, y, d.n, d.pixel * std::max(sx, sy)};
}

inline void SetColor(const RowLayers& out, int i, const Color& c) {
  out.r[i] = c.r;
  out.g[i] = c.g;
  out.b[i] = c.b;
}

inline void SetAll(float* row, int n, float value) { std::fill(row, row + n, value); }

// Width of an edge in cells: what the material wants, but at least 1.3 texels.
inline float EdgeWidth(float wanted, float frequency, float pixel) {
  return std::max(wanted, 1.3f * frequency * pixel);
}

// A base colour and two companions that share its character or contrast with it.
struct Scheme {
  Color base, second, third;
};

template <typename Draw>
Scheme DrawScheme(Rng& rng, Draw draw, float spread) {
  Scheme s;
  s.base = draw(rng);
  s.second = rng.Chance(0.75f) ? Related(rng, s.base, spread) : draw(rng);
  s.third = rng.Chance(0.75f) ? Related(rng, s.second, spread) : draw(rng);
  return s;
}

}  // namespace glint::procedural
