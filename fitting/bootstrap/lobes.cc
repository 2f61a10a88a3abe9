#include "fitting/bootstrap/lobes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/reflectance/brdf.h"

namespace glint {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kBins = 28;
constexpr double kBinDegrees = 2.5;
constexpr int kMinInBin = 12;
constexpr size_t kMaxSamples = 60'000;
constexpr std::array<double, 12> kRoughness{0.12, 0.17, 0.22, 0.27, 0.32, 0.38,
                                            0.44, 0.5,  0.58, 0.66, 0.76, 0.88};
constexpr double kTypicalRoughness = 0.38;
constexpr double kRoughnessPenalty = 0.02;  // of the mean squared residual, per unit of r²

struct Bin {
  std::vector<double> reflectance[3];
  std::array<double, kRoughness.size()> factor{};  // sums of D·G/(4·NoL·NoV), flat
  double fresnel = 0;
};

void Collect(const PhotographSet& set, const Photograph& photo, size_t stride,
             std::vector<Bin>* bins) {
  const size_t texels = photo.mask.size();
  TexelSvbrdf<double> flat{{0, 0, 1}, {0, 0, 0}, {0, 0, 0}, 0.5};
  for (size_t i = stride / 2; i < texels; i += stride) {
    if (photo.mask[i] < 0.5f) continue;
    const float rgb[3] = {photo.rgb[i], photo.rgb[texels + i], photo.rgb[2 * texels + i]};
    const int row = static_cast<int>(i / set.plane.width);
    const int column = static_cast<int>(i % set.plane.width);
    const TexelGeometry<double> g =
        TexelGeometryInView(photo.view, set.convention.falloff, set.plane.x_mm(column),
                            set.plane.y_mm(row));
    const double n_dot_l = g.light[2];
    if (n_dot_l < 0.1 || g.camera[2] < 0.1) continue;
    const double degrees = std::acos(std::min(1.0, g.half[2])) * 180.0 / kPi;
    const int b = static_cast<int>(degrees / kBinDegrees);
    if (b >= kBins) continue;
    Bin& bin = (*bins)[b];
    for (int c = 0; c < 3; ++c) {
      bin.reflectance[c].push_back(std::max(0.0f, rgb[c]) /
                                   std::max(1e-12, g.irradiance[c] * n_dot_l));
    }
    for (size_t r = 0; r < kRoughness.size(); ++r) {
      flat.roughness = kRoughness[r];
      bin.factor[r] += SpecularFactor(flat, g);
    }
    bin.fresnel += g.fresnel;
  }
}

double Median(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

// Least squares of y = a + b·x with a ≥ 0, b ≥ 0 and weights; a weak pull of b to `b0`.
void FitLine(const std::vector<double>& x, const std::vector<double>& y,
             const std::vector<double>& w, double b0, double pull, double* a, double* b) {
  double sw = 0, sx = 0, sy = 0, sxx = pull, sxy = pull * b0;
  for (size_t i = 0; i < x.size(); ++i) {
    sw += w[i];
    sx += w[i] * x[i];
    sy += w[i] * y[i];
    sxx += w[i] * x[i] * x[i];
    sxy += w[i] * x[i] * y[i];
  }
  const double determinant = sw * sxx - sx * sx;
  *b = determinant > 1e-12 * sw * sxx ? (sw * sxy - sx * sy) / determinant : b0;
  *b = std::clamp(*b, 0.0, 1.0);
  *a = (sy - *b * sx) / sw;
  if (*a < 0) {
    *a = 0;
    *b = std::clamp(sxy / sxx, 0.0, 1.0);
  }
}

}  // namespace

GlobalLobes FitGlobalLobes(const PhotographSet& set) {
  const size_t texels = static_cast<size_t>(set.plane.width) * set.plane.height;
  const size_t stride = std::max<size_t>(1, texels * set.photographs.size() / kMaxSamples);
  std::vector<Bin> bins(kBins);
  for (const Photograph& photo : set.photographs) Collect(set, photo, stride, &bins);

  GlobalLobes best;
  std::vector<Bin*> used;
  for (Bin& bin : bins) {
    if (bin.reflectance[0].size() >= kMinInBin) used.push_back(&bin);
  }
  if (used.empty()) return best;
  std::vector<double> count(used.size()), y[3], w[3];
  for (size_t b = 0; b < used.size(); ++b) {
    count[b] = static_cast<double>(used[b]->reflectance[0].size());
    for (int c = 0; c < 3; ++c) {
      y[c].push_back(Median(&used[b]->reflectance[c]));
      // Relative residuals; a bin of many texels counts more, but not by much.
      w[c].push_back(std::sqrt(std::min(count[b], 400.0)) / std::pow(y[c][b] + 0.005, 2));
    }
  }
  double best_cost = std::numeric_limits<double>::infinity();
  for (size_t r = 0; r < kRoughness.size(); ++r) {
    GlobalLobes lobes;
    lobes.roughness = kRoughness[r];
    double cost = 0, weight = 0;
    for (int c = 0; c < 3; ++c) {
      // f = k_d/π + S·F₁ + k_s·S·(1 − F₁), with F₁ the Fresnel rise toward grazing.
      std::vector<double> x(used.size()), target(used.size());
      double scale = 0;
      for (size_t b = 0; b < used.size(); ++b) {
        const double s = used[b]->factor[r] / count[b], f = used[b]->fresnel / count[b];
        x[b] = s * (1 - f);
        target[b] = y[c][b] - s * f;
        scale += w[c][b] * x[b] * x[b];
      }
      double a = 0, k_s = 0;
      FitLine(x, target, w[c], 0.04, 1e-3 * scale, &a, &k_s);
      lobes.diffuse[c] = std::clamp(a * kPi, 0.005, 0.95);
      lobes.specular[c] = std::clamp(k_s, 0.02, 0.95);
      for (size_t b = 0; b < used.size(); ++b) {
        const double residual = lobes.diffuse[c] / kPi + lobes.specular[c] * x[b] - target[b];
        cost += w[c][b] * residual * residual;
        weight += w[c][b] * std::pow(y[c][b] + 0.005, 2);
      }
    }
    cost = cost / weight + kRoughnessPenalty * std::pow(lobes.roughness - kTypicalRoughness, 2);
    if (cost < best_cost) {
      best_cost = cost;
      best = lobes;
    }
  }
  return best;
}

}  // namespace glint
