#include "datasets/procedural/detail.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/cpu/vector_clones.h"
#include "datasets/procedural/random.h"
#include "datasets/procedural/shaping.h"

namespace glint::procedural {
namespace {

constexpr int kLevelOf256 = 8;
constexpr float kFinerGain = 0.6f;
constexpr float kUniformSpread = 0.57735f;  // standard deviation of a lattice value

// Where texels of one axis fall on a lattice.
struct Axis {
  Axis(int texels, int longer, int level)
      : cell(static_cast<size_t>(texels)), part(static_cast<size_t>(texels)) {
    const float cells = std::ldexp(1.0f, level);
    for (int i = 0; i < texels; ++i) {
      const float centre = static_cast<float>(i) + 0.5f - 0.5f * static_cast<float>(texels);
      // Half a cell off, so that a cell a texel gives a lattice value each: white noise.
      const float at = centre / static_cast<float>(longer) * cells + 0.5f * cells - 0.5f;
      const int32_t floor = FloorInt(at);
      if (i == 0) first = floor;
      cell[static_cast<size_t>(i)] = floor - first;
      part[static_cast<size_t>(i)] = at - static_cast<float>(floor);
    }
    count = cell.back() + 2;
  }
  int32_t first = 0;          // lattice index of the first texel
  int32_t count = 0;          // lattice points that the texels touch
  std::vector<int32_t> cell;  // from `first`
  std::vector<float> part;
};

GLINT_VECTOR_CLONES
void LatticeRow(int32_t first, int32_t row, int count, uint32_t seed, float* __restrict out) {
  for (int i = 0; i < count; ++i) out[i] = 2.0f * ToUnit(Hash2(first + i, row, seed)) - 1.0f;
}

GLINT_VECTOR_CLONES
void AddInterpolated(const float* lattice, const int32_t* cell, const float* part, int n,
                     float* __restrict out) {
  for (int i = 0; i < n; ++i) {
    const float low = lattice[cell[i]], high = lattice[cell[i] + 1];
    out[i] += low + (high - low) * part[i];
  }
}

GLINT_VECTOR_CLONES
void MixRows(const float* low, const float* high, float part, float amplitude, int n,
             float* __restrict out) {
  for (int i = 0; i < n; ++i) out[i] = amplitude * (low[i] + (high[i] - low[i]) * part);
}

// Adds one lattice of 2^level cells a unit.
void AddLevel(const DetailOptions& o, int level, float amplitude, int width, int height,
              Plane* out) {
  const int longer = std::max(width, height);
  const Axis x(width, longer, std::max(level - o.stretch_x, 0));
  const Axis y(height, longer, std::max(level - o.stretch_y, 0));
  const uint32_t seed = Hash1(o.seed + 0x51ed270bu * static_cast<uint32_t>(level + 1));
  const size_t count = static_cast<size_t>(x.count);
  std::vector<float> low(count), high(count), mixed(count);
  int32_t held = -1;
  for (int row = 0; row < height; ++row) {
    const int32_t cell = y.cell[static_cast<size_t>(row)];
    if (cell != held) {
      if (held >= 0 && cell == held + 1) {
        std::swap(low, high);
      } else {
        LatticeRow(x.first, y.first + cell, x.count, seed, low.data());
      }
      LatticeRow(x.first, y.first + cell + 1, x.count, seed, high.data());
      held = cell;
    }
    MixRows(low.data(), high.data(), y.part[static_cast<size_t>(row)], amplitude, x.count,
            mixed.data());
    AddInterpolated(mixed.data(), x.cell.data(), x.part.data(), width,
                    out->data() + static_cast<size_t>(row) * width);
  }
}

// Mean over 2·radius + 1 values of a row.
void BoxRow(const float* in, int n, int radius, float* out) {
  const float share = 1.0f / static_cast<float>(2 * radius + 1);
  float sum = in[0] * static_cast<float>(radius + 1);
  for (int i = 1; i <= radius; ++i) sum += in[std::min(i, n - 1)];
  for (int i = 0; i < n; ++i) {
    out[i] = sum * share;
    sum += in[std::min(i + radius + 1, n - 1)] - in[std::max(i - radius, 0)];
  }
}

GLINT_VECTOR_CLONES
void SlideRows(const float* entering, const float* leaving, float share, int n,
               float* __restrict sum, float* __restrict out) {
  for (int i = 0; i < n; ++i) {
    out[i] = sum[i] * share;
    sum[i] += entering[i] - leaving[i];
  }
}

void BoxColumns(const Plane& in, int width, int height, int radius, Plane* out) {
  const float share = 1.0f / static_cast<float>(2 * radius + 1);
  const auto row = [&](int y) {
    return in.data() + static_cast<size_t>(std::clamp(y, 0, height - 1)) * width;
  };
  std::vector<float> sum(static_cast<size_t>(width), 0.0f);
  for (int y = -radius; y <= radius; ++y) {
    const float* from = row(y);
    for (int i = 0; i < width; ++i) sum[static_cast<size_t>(i)] += from[i];
  }
  for (int y = 0; y < height; ++y) {
    SlideRows(row(y + radius + 1), row(y - radius), share, width, sum.data(),
              out->data() + static_cast<size_t>(y) * width);
  }
}

}  // namespace

Plane DetailNoise(const DetailOptions& options, int width, int height) {
  Plane out(static_cast<size_t>(width) * height);
  std::fill(out.begin(), out.end(), 0.0f);
  const int longer = std::max(width, height);
  float power = 0.0f;
  for (int level = options.coarsest; level <= kLevelOf256; ++level) {
    power += std::pow(options.gain, 2.0f * static_cast<float>(level - options.coarsest));
  }
  // Interpolation between lattice values takes about a third of their spread.
  float amplitude = 1.4f / (kUniformSpread * std::sqrt(power));
  for (int level = options.coarsest; std::ldexp(1.0f, level) < 1.5f * longer; ++level) {
    AddLevel(options, level, amplitude, width, height, &out);
    amplitude *= level < kLevelOf256 ? options.gain : std::min(options.gain, 1.0f) * kFinerGain;
  }
  return out;
}

Plane Blurred(const float* plane, int width, int height, int stride, int radius) {
  Plane a(static_cast<size_t>(width) * height), b(a.size());
  std::vector<float> row(static_cast<size_t>(width));
  for (int y = 0; y < height; ++y) {
    BoxRow(plane + static_cast<size_t>(y) * stride, width, radius, row.data());
    BoxRow(row.data(), width, radius, a.data() + static_cast<size_t>(y) * width);
  }
  BoxColumns(a, width, height, radius, &b);
  BoxColumns(b, width, height, radius, &a);
  return a;
}

}  // namespace glint::procedural
