#include "fitting/initial_maps/rules.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel/parallel.h"
#include "base/reflectance/brdf.h"

namespace glint {
namespace {

constexpr int kMinStereoViews = 4;
constexpr double kStereoDamping = 0.02;  // of the matrix's trace
constexpr double kMaxStereoSlope = 0.7;
constexpr double kMaxHighlightShare = 0.35;
constexpr double kMetalDiffuse = 0.06;  // below it, with a strong specular lobe: a metal

// What one photograph says of one texel under the assumption of the global lobes and a flat normal.
struct Reading {
  double ratio[3];         // measured / predicted
  double highlight_share;  // of the prediction
  double light[3];         // direction to the light
  double lambert;          // luminance of π·I/E: albedo·(n·l) of a diffuse texel
  bool clipped;
};

struct TexelReadings {
  std::vector<Reading> list;
  std::vector<double> scratch;
};

bool ReadTexel(const PhotographSet& set, const Photograph& photo, const GlobalLobes& lobes, int row,
               int column, Reading* reading) {
  const size_t texels = photo.mask.size();
  const size_t i = static_cast<size_t>(row) * set.plane.width + column;
  if (photo.mask[i] < 0.5f) return false;
  const TexelGeometry<double> g = TexelGeometryInView(photo.view, set.convention.falloff,
                                                      set.plane.x_mm(column), set.plane.y_mm(row));
  if (g.light[2] < 0.05 || g.camera[2] < 0.05) return false;
  TexelSvbrdf<double> flat{{0, 0, 1}, {}, {}, lobes.roughness};
  std::copy(lobes.diffuse.begin(), lobes.diffuse.end(), flat.diffuse);
  std::copy(lobes.specular.begin(), lobes.specular.end(), flat.specular);
  double predicted[3], total = 0, highlight = 0;
  ShadeRadiance(flat, g, set.convention, predicted);
  reading->clipped = false;
  reading->lambert = 0;
  for (int c = 0; c < 3; ++c) {
    const double measured = std::max(0.0f, photo.rgb[c * texels + i]);
    reading->clipped |= photo.ldr && measured >= 0.99;
    // The offset of the loss: dark texels are not trusted beyond it.
    reading->ratio[c] = (measured + 0.003) / (predicted[c] + 0.003);
    total += predicted[c];
    highlight += predicted[c] - g.irradiance[c] * g.light[2] * lobes.diffuse[c] / std::numbers::pi;
    reading->lambert += std::numbers::pi * measured / std::max(1e-12, 3.0 * g.irradiance[c]);
    reading->light[c] = g.light[c];
  }
  reading->highlight_share = std::clamp(highlight / std::max(1e-12, total), 0.0, 1.0);
  return true;
}

double MedianRatio(TexelReadings* readings, int channel) {
  std::vector<double>& values = readings->scratch;
  values.clear();
  for (const Reading& r : readings->list) {
    if (!r.clipped) values.push_back(r.ratio[channel]);
  }
  // Clipped everywhere: at least as bright as the brightest reading.
  if (values.empty()) {
    for (const Reading& r : readings->list) values.push_back(r.ratio[channel]);
  }
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : std::sqrt(values[n / 2 - 1] * values[n / 2]);
}

// Damped least squares of lambert = g·l; the slopes are g_x/g_z and g_y/g_z.
bool StereoSlopes(const TexelReadings& readings, double slopes[2]) {
  double a[3][3] = {}, b[3] = {};
  int used = 0;
  for (const Reading& r : readings.list) {
    if (r.clipped || r.highlight_share > kMaxHighlightShare) continue;
    ++used;
    for (int i = 0; i < 3; ++i) {
      b[i] += r.light[i] * r.lambert;
      for (int j = 0; j < 3; ++j) a[i][j] += r.light[i] * r.light[j];
    }
  }
  if (used < kMinStereoViews) return false;
  const double damping = kStereoDamping * (a[0][0] + a[1][1] + a[2][2]);
  a[0][0] += damping;
  a[1][1] += damping;
  // Solve by Cramer's rule: damped in x and y, the matrix is regular.
  const auto determinant = [](const double m[3][3]) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  const double whole = determinant(a);
  if (!(whole > 0)) return false;
  double g[3];
  for (int k = 0; k < 3; ++k) {
    double m[3][3];
    std::copy(&a[0][0], &a[0][0] + 9, &m[0][0]);
    for (int i = 0; i < 3; ++i) m[i][k] = b[i];
    g[k] = determinant(m) / whole;
  }
  if (!(g[2] > 1e-6)) return false;
  for (int k = 0; k < 2; ++k) {
    slopes[k] = std::clamp(g[k] / g[2], -kMaxStereoSlope, kMaxStereoSlope);
  }
  return true;
}

void EstimateTexel(const GlobalLobes& lobes, TexelReadings* readings, int row, int column,
                   SvbrdfMaps* maps) {
  double slopes[2] = {0, 0};
  double ratio[3] = {1, 1, 1};
  if (!readings->list.empty()) {
    for (int c = 0; c < 3; ++c) ratio[c] = std::clamp(MedianRatio(readings, c), 0.02, 6.0);
    StereoSlopes(*readings, slopes);
  }
  const double mean_diffuse = (lobes.diffuse[0] + lobes.diffuse[1] + lobes.diffuse[2]) / 3;
  const double mean_specular = (lobes.specular[0] + lobes.specular[1] + lobes.specular[2]) / 3;
  const bool metal = mean_diffuse < kMetalDiffuse && mean_specular > 2 * mean_diffuse;
  for (int c = 0; c < 3; ++c) {
    maps->at(kDiffuseR + c, row, column) =
        static_cast<float>(std::clamp(lobes.diffuse[c] * ratio[c], 0.002, 0.98));
    const double specular = metal ? lobes.specular[c] * std::min(ratio[c], 3.0) : lobes.specular[c];
    maps->at(kSpecularR + c, row, column) = static_cast<float>(std::clamp(specular, 0.02, 0.98));
  }
  maps->at(kRoughness, row, column) = static_cast<float>(lobes.roughness);
  const double z = 1 / std::sqrt(1 + slopes[0] * slopes[0] + slopes[1] * slopes[1]);
  maps->at(kNormalX, row, column) = static_cast<float>(slopes[0] * z);
  maps->at(kNormalY, row, column) = static_cast<float>(slopes[1] * z);
  maps->at(kNormalZ, row, column) = static_cast<float>(z);
}

}  // namespace

SvbrdfMaps EstimateMaps(const PhotographSet& set, int threads) {
  const GlobalLobes lobes = FitGlobalLobes(set);
  SvbrdfMaps maps(set.plane.width, set.plane.height);
  ForEachBlock(set.plane.height, 8, threads, [&](int begin, int end) {
    TexelReadings readings;
    for (int row = begin; row < end; ++row) {
      for (int column = 0; column < set.plane.width; ++column) {
        readings.list.clear();
        Reading reading;
        for (const Photograph& photo : set.photographs) {
          if (ReadTexel(set, photo, lobes, row, column, &reading)) readings.list.push_back(reading);
        }
        EstimateTexel(lobes, &readings, row, column, &maps);
      }
    }
  });
  return maps;
}

}  // namespace glint
