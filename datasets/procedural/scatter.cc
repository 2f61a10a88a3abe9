#include "datasets/procedural/scatter.h"

#include <algorithm>
#include <cmath>

#include "base/cpu/vector_clones.h"
#include "datasets/procedural/random.h"
#include "datasets/procedural/shaping.h"

namespace glint::procedural {
namespace {

GLINT_VECTOR_CLONES
void ScatterKernel(const ScatterOptions o, const float* x, const float* y, int n,
                   float* __restrict out_u, float* __restrict out_v, float* __restrict out_inset,
                   uint32_t* __restrict out_id) {
  const float per_length = 1.0f / o.half_length, per_width = 1.0f / o.half_width;
  for (int i = 0; i < n; ++i) {
    const float px = x[i] * o.frequency, py = y[i] * o.frequency;
    const int32_t ix = FloorInt(px), iy = FloorInt(py);
    const float fx = px - static_cast<float>(ix), fy = py - static_cast<float>(iy);
    float best_u = 0.0f, best_v = 0.0f, best_inset = -1.0f;
    int32_t best_rank = -1;
    uint32_t best_id = 0;
#pragma GCC unroll 9
    for (int k = 0; k < 9; ++k) {
      const int32_t cx = k % 3 - 1, cy = k / 3 - 1;
      const uint32_t h = Hash2(ix + cx, iy + cy, o.seed);
      const float jitter_x = static_cast<float>(static_cast<int32_t>(h & 0xffu)) / 256.0f;
      const float jitter_y = static_cast<float>(static_cast<int32_t>((h >> 8) & 0xffu)) / 256.0f;
      const float dx = fx - static_cast<float>(cx) - jitter_x;
      const float dy = fy - static_cast<float>(cy) - jitter_y;
      const uint32_t again = h * 0x9e3779b1u;
      const float turn = o.angle_turns + o.angle_spread * (ToUnit(again) - 0.5f);
      const float c = CosTurn(turn), s = SinTurn(turn);
      const float u = (c * dx + s * dy) * per_length, v = (c * dy - s * dx) * per_width;
      const float leaf = 1.0f - u * u - std::fabs(v);
      const float chip = 1.0f - std::max(std::fabs(u), std::fabs(v));
      const float inset = leaf + o.square * (chip - leaf);
      const int32_t rank = static_cast<int32_t>(h >> 16);
      const bool there =
          static_cast<float>(static_cast<int32_t>(again & 0xffu)) < 256.0f * o.presence;
      const bool above = there & (inset > 0.0f) & (rank > best_rank);
      best_u = above ? u : best_u;
      best_v = above ? v : best_v;
      best_inset = above ? inset : best_inset;
      best_rank = above ? rank : best_rank;
      best_id = above ? h : best_id;
    }
    out_u[i] = best_u;
    out_v[i] = best_v;
    out_inset[i] = best_inset;
    out_id[i] = best_id;
  }
}

}  // namespace

ScatterRows TakeScatterRows(Scratch& scratch) {
  return {scratch.Row(), scratch.Row(), scratch.Row(), scratch.Ids()};
}

void ScatterThings(const ScatterOptions& options, const float* x, const float* y, int n,
                   float pixel, const ScatterRows& out) {
  ScatterOptions o = options;
  o.half_width = std::min(std::max(o.half_width, 1.2f * o.frequency * pixel), o.half_length);
  ScatterKernel(o, x, y, n, out.u, out.v, out.inset, out.id);
}

}  // namespace glint::procedural
