#include "datasets/procedural/noise.h"

#include <cmath>

#include "base/cpu/vector_clones.h"
#include "datasets/procedural/random.h"
#include "datasets/procedural/shaping.h"

namespace glint::procedural {
namespace {

// Dot product of a hashed gradient with (x, y); the gradient is uniform in a square.
inline float CornerGradient(uint32_t h, float x, float y) {
  const float gx = static_cast<float>(static_cast<int32_t>(h & 0xffffu)) * (2.0f / 65535.0f) - 1.0f;
  const float gy = static_cast<float>(static_cast<int32_t>(h >> 16)) * (2.0f / 65535.0f) - 1.0f;
  return gx * x + gy * y;
}

inline float GradientNoise(float x, float y, uint32_t seed) {
  const int32_t ix = FloorInt(x);
  const int32_t iy = FloorInt(y);
  const float fx = x - static_cast<float>(ix);
  const float fy = y - static_cast<float>(iy);
  const float a = CornerGradient(Hash2(ix, iy, seed), fx, fy);
  const float b = CornerGradient(Hash2(ix + 1, iy, seed), fx - 1.0f, fy);
  const float c = CornerGradient(Hash2(ix, iy + 1, seed), fx, fy - 1.0f);
  const float d = CornerGradient(Hash2(ix + 1, iy + 1, seed), fx - 1.0f, fy - 1.0f);
  const float u = fx * fx * fx * (fx * (fx * 6.0f - 15.0f) + 10.0f);
  const float v = fy * fy * fy * (fy * (fy * 6.0f - 15.0f) + 10.0f);
  return 1.6f * Mix(Mix(a, b, u), Mix(c, d, u), v);
}

// out = bias·amplitude + amplitude·(a·noise + b·|noise|), added to what is there.
GLINT_VECTOR_CLONES
void AddOctave(const float* x, const float* y, int n, float fx, float fy, uint32_t seed, float a,
               float b, float* __restrict out) {
  for (int i = 0; i < n; ++i) {
    const float value = GradientNoise(x[i] * fx, y[i] * fy, seed);
    out[i] += a * value + b * std::fabs(value);
  }
}

GLINT_VECTOR_CLONES
void VoronoiKernel(float frequency, float jitter, uint32_t seed, const float* x, const float* y,
                   int n, float* __restrict out_dx, float* __restrict out_dy,
                   float* __restrict out_edge, uint32_t* __restrict out_id) {
  const float low = 0.5f - 0.5f * jitter;
  const float scale = jitter / 65536.0f;
  for (int i = 0; i < n; ++i) {
    const float px = x[i] * frequency;
    const float py = y[i] * frequency;
    const int32_t ix = FloorInt(px);
    const int32_t iy = FloorInt(py);
    const float fx = px - static_cast<float>(ix);
    const float fy = py - static_cast<float>(iy);
    float best = 1e9f, best_x = 0.0f, best_y = 0.0f;
    uint32_t best_id = 0;
#pragma GCC unroll 9
    for (int k = 0; k < 9; ++k) {
      const int32_t cx = k % 3 - 1, cy = k / 3 - 1;
      const uint32_t h = Hash2(ix + cx, iy + cy, seed);
      const float dx = static_cast<float>(cx) - fx + low +
                       scale * static_cast<float>(static_cast<int32_t>(h & 0xffffu));
      const float dy = static_cast<float>(cy) - fy + low +
                       scale * static_cast<float>(static_cast<int32_t>(h >> 16));
      const float d = dx * dx + dy * dy;
      const bool nearer = d < best;
      best = nearer ? d : best;
      best_x = nearer ? dx : best_x;
      best_y = nearer ? dy : best_y;
      best_id = nearer ? h : best_id;
    }
    float edge = 1e9f;
#pragma GCC unroll 9
    for (int k = 0; k < 9; ++k) {
      const int32_t cx = k % 3 - 1, cy = k / 3 - 1;
      const uint32_t h = Hash2(ix + cx, iy + cy, seed);
      const float dx = static_cast<float>(cx) - fx + low +
                       scale * static_cast<float>(static_cast<int32_t>(h & 0xffffu));
      const float dy = static_cast<float>(cy) - fy + low +
                       scale * static_cast<float>(static_cast<int32_t>(h >> 16));
      const float gx = dx - best_x, gy = dy - best_y;
      const float gap = gx * gx + gy * gy;
      const float along = 0.5f * (dx * dx + dy * dy - best) / std::sqrt(std::max(gap, 1e-6f));
      edge = gap > 1e-6f ? std::min(edge, along) : edge;
    }
    out_dx[i] = best_x;
    out_dy[i] = best_y;
    out_edge[i] = edge;
    out_id[i] = best_id;
  }
}

}  // namespace

void FractalNoise(const NoiseOptions& options, const float* x, const float* y, int n, float pixel,
                  float* out) {
  const bool ridged = options.kind == NoiseKind::kRidged;
  const bool smooth = options.kind == NoiseKind::kSmooth;
  float total = 0.0f, power = 0.0f, amplitude = 1.0f, frequency = options.frequency;
  for (int o = 0; o < options.octaves; ++o, amplitude *= options.gain) {
    total += amplitude;
    power += amplitude * amplitude;
  }
  std::fill(out, out + n, ridged ? 1.0f : 0.0f);
  // Signed octaves partly cancel: keep their spread, not their bound.
  amplitude = smooth ? 1.2f / std::sqrt(power) : 1.0f / total;
  for (int o = 0; o < options.octaves; ++o) {
    const float finest = frequency * std::max(options.stretch, 1.0f) * pixel;  // cells per texel
    const float fade = Clamp01((0.7f - finest) / 0.35f);
    if (fade <= 0.0f) break;
    const float weight = amplitude * fade;
    const uint32_t seed = Hash1(options.seed + 0x51ed270bu * static_cast<uint32_t>(o + 1));
    AddOctave(x, y, n, frequency, frequency * options.stretch, seed, smooth ? weight : 0.0f,
              smooth ? 0.0f : (ridged ? -1.6f : 1.6f) * weight, out);
    frequency *= options.lacunarity;
    amplitude *= options.gain;
  }
}

void Voronoi(float frequency, float jitter, uint32_t seed, const float* x, const float* y, int n,
             const VoronoiRows& out) {
  VoronoiKernel(frequency, jitter, seed, x, y, n, out.dx, out.dy, out.edge, out.id);
}

}  // namespace glint::procedural
