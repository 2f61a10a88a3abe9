#include "datasets/procedural/patterns.h"

#include <cmath>

#include "base/cpu/vector_clones.h"
#include "datasets/procedural/noise.h"
#include "datasets/procedural/random.h"
#include "datasets/procedural/shaping.h"

namespace glint::procedural {
namespace {

inline uint32_t WithParity(uint32_t hash, int32_t parity) {
  return (hash & ~1u) | (static_cast<uint32_t>(parity) & 1u);
}

GLINT_VECTOR_CLONES
void BondRow(const TilingOptions o, const float* x, const float* y, int n, const TilingRows out) {
  const float aspect = static_cast<float>(o.aspect);
  const float half = o.tiling == Tiling::kRunningBond ? 0.5f : 0.0f;
  const float third = o.tiling == Tiling::kThirdBond ? 1.0f / 3.0f : 0.0f;
  const float random = o.tiling == Tiling::kRandomBond ? 1.0f : 0.0f;
  for (int i = 0; i < n; ++i) {
    const float py = y[i] * o.frequency;
    const int32_t row = FloorInt(py);
    const float odd = static_cast<float>(row & 1);
    const float shift =
        half * odd + third * static_cast<float>(row) + random * ToUnit(Hash2(row, 7, o.seed));
    const float px = x[i] * o.frequency / aspect + shift;
    const int32_t column = FloorInt(px);
    const float u = (px - static_cast<float>(column) - 0.5f) * aspect;
    const float v = py - static_cast<float>(row) - 0.5f;
    out.u[i] = u;
    out.v[i] = v;
    out.edge[i] = std::min(0.5f * aspect - std::fabs(u), 0.5f - std::fabs(v));
    out.id[i] = WithParity(Hash2(column, row, o.seed), column + row);
  }
}

void HerringboneRow(const TilingOptions o, const float* x, const float* y, int n,
                    const TilingRows out) {
  const int32_t k = o.aspect;
  const float length = static_cast<float>(k);
  for (int i = 0; i < n; ++i) {
    const float px = x[i] * o.frequency, py = y[i] * o.frequency;
    const int32_t ix = FloorInt(px), iy = FloorInt(py);
    const float fx = px - static_cast<float>(ix), fy = py - static_cast<float>(iy);
    const int32_t d = ((ix - iy) % (2 * k) + 2 * k) % (2 * k);
    const bool flat = d < k;
    const int32_t step = flat ? d : 2 * k - 1 - d;
    const float along = static_cast<float>(step) + (flat ? fx : fy);
    const float u = along - 0.5f * length;
    const float v = (flat ? fy : fx) - 0.5f;
    out.u[i] = u;
    out.v[i] = v;
    out.edge[i] = std::min(0.5f * length - std::fabs(u), 0.5f - std::fabs(v));
    const uint32_t h =
        Hash2(flat ? ix - step : ix, flat ? iy : iy - step, o.seed + (flat ? 0u : 77u));
    out.id[i] = WithParity(h, flat);
  }
}

void BasketRow(const TilingOptions o, const float* x, const float* y, int n, const TilingRows out) {
  const float k = static_cast<float>(o.aspect);
  for (int i = 0; i < n; ++i) {
    const float px = x[i] * o.frequency / k, py = y[i] * o.frequency / k;
    const int32_t ix = FloorInt(px), iy = FloorInt(py);
    const float fx = (px - static_cast<float>(ix)) * k, fy = (py - static_cast<float>(iy)) * k;
    const bool turned = ((ix + iy) & 1) != 0;
    const float along = turned ? fy : fx, across = turned ? fx : fy;
    const int32_t slat = FloorInt(across);
    const float u = along - 0.5f * k;
    const float v = across - static_cast<float>(slat) - 0.5f;
    out.u[i] = u;
    out.v[i] = v;
    out.edge[i] = std::min(0.5f * k - std::fabs(u), 0.5f - std::fabs(v));
    out.id[i] = WithParity(Hash2(ix, iy, Hash1(o.seed + static_cast<uint32_t>(slat))), turned);
  }
}

// Hexagons of inner diameter 1: the nearer centre of two interleaved rectangular lattices.
GLINT_VECTOR_CLONES
void HexagonRow(const TilingOptions o, const float* x, const float* y, int n,
                const TilingRows out) {
  constexpr float kTall = 1.7320508f;
  for (int i = 0; i < n; ++i) {
    const float px = x[i] * o.frequency, py = y[i] * o.frequency;
    const int32_t ax = FloorInt(px + 0.5f), ay = FloorInt(py / kTall + 0.5f);
    const int32_t bx = FloorInt(px), by = FloorInt(py / kTall);
    const float au = px - static_cast<float>(ax), av = py - kTall * static_cast<float>(ay);
    const float bu = px - static_cast<float>(bx) - 0.5f;
    const float bv = py - kTall * (static_cast<float>(by) + 0.5f);
    const bool first = au * au + av * av < bu * bu + bv * bv;
    const float u = first ? au : bu, v = first ? av : bv;
    const float slanted = 0.5f * std::fabs(u) + 0.8660254f * std::fabs(v);
    out.u[i] = u;
    out.v[i] = v;
    out.edge[i] = 0.5f - std::max(std::fabs(u), slanted);
    out.id[i] =
        WithParity(Hash2(first ? ax : bx, first ? ay : by, o.seed + (first ? 0u : 91u)), first);
  }
}

GLINT_VECTOR_CLONES
void StreakRow(const StreakOptions o, const float* x, const float* y, int n, float widest,
               float* __restrict profile, uint32_t* __restrict id) {
  const float c = CosTurn(o.angle_turns), s = SinTurn(o.angle_turns);
  const float per_length = 1.0f / o.length;
  const float shrink = 2.0f / widest;
  for (int i = 0; i < n; ++i) {
    const float along = (c * x[i] + s * y[i]) * per_length;
    const float wander = o.bend * (SinTurn(along * 0.61f + 0.1f) + 0.5f * SinTurn(along * 1.7f));
    const float across = (c * y[i] - s * x[i]) * o.lanes + wander;
    const int32_t lane = FloorInt(across);
    const float slot = along + 16.0f * ToUnit(Hash2(lane, 3, o.seed));
    const int32_t cut = FloorInt(slot);
    const uint32_t h = Hash2(lane, cut, o.seed ^ 0x3c6ef372u);
    const float t = slot - static_cast<float>(cut);
    const float taper = std::min(8.0f * t * (1.0f - t), 1.0f);
    const float side = (across - static_cast<float>(lane) - 0.5f) * shrink;
    const float body = std::max(1.0f - side * side, 0.0f);
    profile[i] = ToUnit(h) < o.presence ? taper * body : 0.0f;
    id[i] = h;
  }
}

}  // namespace

TilingRows TakeTilingRows(Scratch& scratch) {
  return {scratch.Row(), scratch.Row(), scratch.Row(), scratch.Ids()};
}

void Tile(const TilingOptions& o, const float* x, const float* y, int n, const TilingRows& out) {
  switch (o.tiling) {
    case Tiling::kHerringbone:
      return HerringboneRow(o, x, y, n, out);
    case Tiling::kBasket:
      return BasketRow(o, x, y, n, out);
    case Tiling::kHexagon:
      return HexagonRow(o, x, y, n, out);
    case Tiling::kVoronoi:
      return Voronoi(o.frequency, o.jitter, o.seed, x, y, n, {out.u, out.v, out.edge, out.id});
    default:
      return BondRow(o, x, y, n, out);
  }
}

void Streaks(const StreakOptions& o, const float* x, const float* y, int n, float pixel,
             float* profile, uint32_t* id) {
  // A streak thinner than a texel would alias: widen it to one texel, dim it by as much.
  const float texel = o.lanes * pixel;
  const float widest = std::min(std::max(o.width, 1.5f * texel), 1.0f);
  StreakRow(o, x, y, n, widest, profile, id);
  const float dim = std::min(o.width / widest, 1.0f);
  if (dim < 1.0f) {
    for (int i = 0; i < n; ++i) profile[i] *= dim;
  }
}

}  // namespace glint::procedural
