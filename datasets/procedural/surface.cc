#include "datasets/procedural/surface.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/cpu/vector_clones.h"
#include "datasets/procedural/finish.h"
#include "datasets/procedural/shaping.h"
#include "datasets/procedural/weathering.h"

namespace glint::procedural {
namespace {

constexpr float kSteepest = 4.2f;  // slopes approach this tangent (76.6°) and never pass it
constexpr float kMostF0 = 0.08f, kMostFinishedF0 = 0.2f;
constexpr float kProbeStep = 1.0f / 256;  // where relief is measured, whatever the picture's size
constexpr int kProbeRows = 16;
constexpr int kProbePoints = 64;

// Where the picture lies in the pattern's plane.
struct Placement {
  float xx, xy, yx, yy;  // picture to pattern, with zoom
  float x0, y0;
  float zoom;

  void Zoom(const PatternScale& scale) {
    xx *= scale.x;
    xy *= scale.x;
    yx *= scale.y;
    yy *= scale.y;
    zoom *= std::max(scale.x, scale.y);
  }
};

Placement DrawPlacement(Rng& rng, bool directional) {
  const float any = rng.Unit();
  const float quarter = 0.25f * static_cast<float>(rng.Int(0, 3));
  const float turn = directional && rng.Chance(0.55f) ? quarter : any;
  const float zoom = rng.LogUniform(0.55f, 1.7f);
  const float mirror = rng.Chance(0.5f) ? -1.0f : 1.0f;
  // Quarter turns exactly, so that straight rows stay straight.
  const float c = turn == quarter ? std::round(CosTurn(turn)) : CosTurn(turn);
  const float s = turn == quarter ? std::round(SinTurn(turn)) : SinTurn(turn);
  return {zoom * c * mirror,
          -zoom * s,
          zoom * s * mirror,
          zoom * c,
          rng.Uniform(-30.0f, 30.0f),
          rng.Uniform(-30.0f, 30.0f),
          zoom};
}

class Surface {
 public:
  Surface(const Family& family, uint64_t seed, const PatternScale& scale) {
    Rng rng(seed);
    placement_ = DrawPlacement(rng, family.directional);
    placement_.Zoom(scale);
    slope_ = rng.LogUniform(family.slope_low, family.slope_high);
    const float kind = rng.Unit();
    if (kind < 0.12f) slope_ *= 0.1f;                     // polished, pressed, worn flat
    if (kind > 0.90f) slope_ *= rng.Uniform(1.5f, 3.0f);  // rugged: the tail of steep normals
    slope_ *= scale.relief;
    metal_residue_ = rng.Chance(0.5f) ? rng.Uniform(0.0f, 0.06f) : 0.0f;
    rows_ = family.draw(rng);
    weathering_ = DrawWeathering(rng);
  }

  // Picture coordinates: origin at the centre, x right, y up, the longer side one unit.
  void Evaluate(const float* x, const float* y, int n, float pixel, float* px, float* py,
                Scratch& scratch, const RowLayers& out) const {
    const Placement p = placement_;
    for (int i = 0; i < n; ++i) {
      px[i] = p.xx * x[i] + p.xy * y[i] + p.x0;
      py[i] = p.yx * x[i] + p.yy * y[i] + p.y0;
    }
    const RowDomain d{px, py, n, pixel * p.zoom};
    scratch.Reset();
    rows_(d, scratch, out);
    weathering_(d, scratch, out);
  }

  float slope() const { return slope_; }
  float metal_residue() const { return metal_residue_; }

  // The factor that brings the relief to the drawn slope.
  float ReliefScale() const;

 private:
  Placement placement_;
  float slope_;
  float metal_residue_;
  RowFunction rows_;
  RowFunction weathering_;
};

// Buffers of one row of points and of all layers but height.
struct RowBuffers {
  explicit RowBuffers(int n) : storage(static_cast<size_t>(n) * 10) {
    float* next = storage.data();
    for (float** row : {&x, &y, &px, &py, &r, &g, &b, &metal, &f0, &roughness}) {
      *row = next;
      next += n;
    }
  }
  RowLayers Layers(float* height) const { return {height, r, g, b, metal, f0, roughness}; }

  std::vector<float> storage;
  float *x, *y, *px, *py, *r, *g, *b, *metal, *f0, *roughness;
};

float Surface::ReliefScale() const {
  RowBuffers rows(kProbePoints);
  Scratch scratch(kProbePoints);
  std::vector<float> heights(3 * kProbePoints);
  double sum = 0.0;
  for (int row = 0; row < kProbeRows; ++row) {
    for (int corner = 0; corner < 3; ++corner) {
      const float dx = corner == 1 ? kProbeStep : 0.0f, dy = corner == 2 ? kProbeStep : 0.0f;
      for (int i = 0; i < kProbePoints; ++i) {
        // Rows shifted by a golden ratio, so that no lattice hides between the probes.
        const float shift = Fract(0.618034f * static_cast<float>(row));
        rows.x[i] = (static_cast<float>(i) + shift) / kProbePoints - 0.5f + dx;
        rows.y[i] =
            (static_cast<float>(row) + Fract(0.7549f * static_cast<float>(i))) / kProbeRows - 0.5f +
            dy;
      }
      Evaluate(rows.x, rows.y, kProbePoints, kProbeStep, rows.px, rows.py, scratch,
               rows.Layers(heights.data() + corner * kProbePoints));
    }
    for (int i = 0; i < kProbePoints; ++i) {
      const float h = heights[i];
      const float sx = (heights[kProbePoints + i] - h) / kProbeStep;
      const float sy = (heights[2 * kProbePoints + i] - h) / kProbeStep;
      sum += std::min(static_cast<double>(sx * sx + sy * sy), 1e4);
    }
  }
  const float rms = static_cast<float>(std::sqrt(sum / (kProbeRows * kProbePoints)));
  return slope_ / std::max(rms, 0.1f);
}

// A row of values without their border, into the planes.
void StoreRow(const RowBuffers& rows, int row, LayerPlanes* planes) {
  const size_t n = static_cast<size_t>(planes->width), at = static_cast<size_t>(row) * n;
  const auto store = [&](const float* from, Plane* to) {
    std::copy_n(from + 1, n, to->data() + at);
  };
  store(rows.r, &planes->r);
  store(rows.g, &planes->g);
  store(rows.b, &planes->b);
  store(rows.metal, &planes->metal);
  store(rows.f0, &planes->f0);
  store(rows.roughness, &planes->roughness);
}

// `residue`: part of a metal's colour that its oxide and dust scatter diffusely.
GLINT_VECTOR_CLONES
void WriteAlbedo(const float* base, const float* metal, const float* f0_plane, float residue,
                 float most_f0, size_t n, float* __restrict diffuse, float* __restrict specular) {
  for (size_t i = 0; i < n; ++i) {
    const float f0 = std::min(std::max(f0_plane[i], 0.02f), most_f0);
    const float m = Clamp01(metal[i]);
    const float color = Clamp01(base[i]);
    const float mirror = Mix(f0, (1.0f - residue) * color, m);
    specular[i] = mirror;
    diffuse[i] = std::min(Mix(1.0f, residue, m) * color, 1.0f - mirror);
  }
}

void WriteReflectance(const LayerPlanes& planes, float residue, float most_f0, SvbrdfMaps& maps) {
  const Plane* base[3] = {&planes.r, &planes.g, &planes.b};
  for (int c = 0; c < 3; ++c) {
    WriteAlbedo(base[c]->data(), planes.metal.data(), planes.f0.data(), residue, most_f0,
                maps.texels(), maps.plane(kDiffuseR + c).data(), maps.plane(kSpecularR + c).data());
  }
  float* roughness = maps.plane(kRoughness).data();
  for (size_t i = 0; i < maps.texels(); ++i) {
    roughness[i] = std::min(std::max(planes.roughness[i], 0.05f), 1.0f);
  }
}

// Central differences of the heights of three rows, with a border either side.
GLINT_VECTOR_CLONES
void NormalRow(const float* above, const float* here, const float* below, float scale, int n,
               float* __restrict nx, float* __restrict ny, float* __restrict nz) {
  for (int i = 0; i < n; ++i) {
    const float sx = scale * (here[i + 1] - here[i - 1]);
    const float sy = scale * (above[i] - below[i]);
    const float square = sx * sx + sy * sy;
    const float limit = 1.0f / std::sqrt(1.0f + square / (kSteepest * kSteepest));
    const float z = 1.0f / std::sqrt(1.0f + square * limit * limit);
    nx[i] = -sx * limit * z;
    ny[i] = -sy * limit * z;
    nz[i] = z;
  }
}

void WriteNormals(LayerPlanes* planes, float scale, SvbrdfMaps& maps) {
  for (int row = 0; row < maps.height; ++row) {
    const size_t at = static_cast<size_t>(row) * maps.width;
    NormalRow(planes->HeightRow(row - 1), planes->HeightRow(row), planes->HeightRow(row + 1), scale,
              maps.width, maps.plane(kNormalX).data() + at, maps.plane(kNormalY).data() + at,
              maps.plane(kNormalZ).data() + at);
  }
}

}  // namespace

SvbrdfMaps MakeSurface(const Family& family, uint64_t seed, std::optional<uint64_t> finish,
                       int width, int height) {
  const Surface surface(family, seed, finish ? FinishScale(*finish) : PatternScale());
  const float longer = static_cast<float>(std::max(width, height));
  const float pixel = 1.0f / longer;
  const int n = width + 2;
  LayerPlanes planes(width, height);
  RowBuffers rows(n);
  Scratch scratch(n);
  for (int row = -1; row <= height; ++row) {
    const float y = (0.5f * static_cast<float>(height) - static_cast<float>(row) - 0.5f) * pixel;
    for (int i = 0; i < n; ++i) {
      rows.x[i] = (static_cast<float>(i) - 0.5f - 0.5f * static_cast<float>(width)) * pixel;
      rows.y[i] = y;
    }
    surface.Evaluate(rows.x, rows.y, n, pixel, rows.px, rows.py, scratch,
                     rows.Layers(planes.HeightRow(row) - 1));
    if (row >= 0 && row < height) StoreRow(rows, row, &planes);
  }
  float scale = surface.ReliefScale();
  if (finish) {
    for (float& h : planes.heights) h *= scale;
    scale = 1.0f;
    FinishSurface(*finish, surface.slope(), &planes);
  }
  SvbrdfMaps maps(width, height);
  WriteReflectance(planes, surface.metal_residue(), finish ? kMostFinishedF0 : kMostF0, maps);
  WriteNormals(&planes, scale * 0.5f * longer, maps);
  return maps;
}

}  // namespace glint::procedural
