#include "base/reflectance/environment_lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

using ByDegree = std::array<double, kEnvironmentDegree + 1>;

constexpr size_t TermOf(int degree, int m) {
  return static_cast<size_t>(degree * (degree + 1) + m);
}

// (degree − m)! / (degree + m)!
double RatioOfFactorials(int degree, int m) {
  double ratio = 1;
  for (int i = degree - m + 1; i <= degree + m; ++i) ratio /= i;
  return ratio;
}

std::array<double, kEnvironmentTerms> Scales() {
  std::array<double, kEnvironmentTerms> scales{};
  for (int l = 0; l <= kEnvironmentDegree; ++l) {
    scales[TermOf(l, 0)] = std::sqrt(2 * l + 1);
    for (int m = 1; m <= l; ++m) {
      const double scale = std::sqrt(2 * (2 * l + 1) * RatioOfFactorials(l, m));
      scales[TermOf(l, m)] = scales[TermOf(l, -m)] = scale;
    }
  }
  return scales;
}

// (x, y, z): unit. By P_l^m(z) / sin^m, with sin^m·cos(m·azimuth) and sin^m·sin(m·azimuth) as
// polynomials of x and y: nothing divides where the azimuth is undefined.
EnvironmentHarmonics HarmonicsAt(double x, double y, double z, int degree) {
  static const std::array<double, kEnvironmentTerms> kScales = Scales();
  EnvironmentHarmonics terms{};
  double cosine = 1, sine = 0, diagonal = 1;  // of m; diagonal: P_m^m / sin^m
  for (int m = 0; m <= degree; ++m) {
    double below = 0, at = diagonal;  // degrees l − 1 and l
    for (int l = m; l <= degree; ++l) {
      const size_t plus = TermOf(l, m), minus = TermOf(l, -m);
      terms[minus] = kScales[minus] * at * sine;
      terms[plus] = kScales[plus] * at * cosine;
      const double above = ((2 * l + 1) * z * at - (l + m) * below) / (l + 1 - m);
      below = at;
      at = above;
    }
    diagonal *= 2 * m + 1;
    const double next = cosine * x - sine * y;
    sine = cosine * y + sine * x;
    cosine = next;
  }
  return terms;
}

EnvironmentHarmonics Filtered(EnvironmentHarmonics terms, const ByDegree& filter, int degree) {
  for (int l = 0; l <= degree; ++l) {
    for (int m = -l; m <= l; ++m) terms[TermOf(l, m)] *= filter[static_cast<size_t>(l)];
  }
  return terms;
}

// Irradiance of a plane by radiance; degrees above 2 reach less than a twentieth of a diffuse
// surface.
EnvironmentHarmonics DiffuseHarmonics(const double n[3]) {
  ByDegree filter{};
  filter[0] = std::numbers::pi;
  filter[1] = 2 * std::numbers::pi / 3;
  filter[2] = std::numbers::pi / 4;
  return Filtered(HarmonicsAt(n[0], n[1], n[2], 2), filter, 2);
}

// P_0 … of x.
ByDegree LegendreAt(double x) {
  ByDegree p{};
  p[0] = 1;
  p[1] = x;
  for (size_t l = 2; l < p.size(); ++l) {
    const double n = static_cast<double>(l);
    p[l] = ((2 * n - 1) * x * p[l - 1] - (n - 1) * p[l - 2]) / n;
  }
  return p;
}

ByDegree IntegrateLobe(double roughness) {
  constexpr int kSteps = 512;
  const double alpha = std::max(roughness * roughness, 1e-4), k = alpha / 2;
  ByDegree sums{};
  for (int i = 0; i < kSteps; ++i) {
    // Cubes of equal steps: narrow lobes are near 0.
    const double t = (i + 0.5) / kSteps;
    const double theta = 0.25 * std::numbers::pi * t * t * t;
    const double width = 0.25 * std::numbers::pi * 3 * t * t / kSteps;
    const double cosine = std::cos(theta), sine = std::sin(theta), lit = std::cos(2 * theta);
    const double ratio = alpha / (cosine * cosine * (alpha * alpha - 1) + 1);
    const double masking = lit / (lit * (1 - k) + k);
    const double weight = 2 * ratio * ratio * masking * cosine * sine * width;
    const ByDegree p = LegendreAt(lit);
    for (size_t l = 0; l < p.size(); ++l) sums[l] += weight * p[l];
  }
  return sums;
}

constexpr int kKnots = 32;

std::array<ByDegree, kKnots + 1> TabulateLobes() {
  std::array<ByDegree, kKnots + 1> lobes;
  for (int i = 0; i <= kKnots; ++i) {
    lobes[static_cast<size_t>(i)] = IntegrateLobe(static_cast<double>(i) / kKnots);
  }
  return lobes;
}

// Linear between knots of roughness.
ByDegree SpecularFilter(double roughness) {
  static const auto kLobes = TabulateLobes();
  const double at = std::clamp(roughness, 0.0, 1.0) * kKnots;
  const size_t knot = std::min(static_cast<size_t>(at), static_cast<size_t>(kKnots - 1));
  const double share = at - static_cast<double>(knot);
  ByDegree filter;
  for (size_t l = 0; l < filter.size(); ++l) {
    filter[l] = std::numbers::pi * ((1 - share) * kLobes[knot][l] + share * kLobes[knot + 1][l]);
  }
  return filter;
}

}  // namespace

bool AreEnvironmentTerms(size_t terms) {
  const auto degrees = static_cast<size_t>(std::lround(std::sqrt(static_cast<double>(terms))));
  return terms <= kEnvironmentTerms && degrees * degrees == terms;
}

int EnvironmentLighting::degree() const {
  return static_cast<int>(std::lround(std::sqrt(static_cast<double>(terms())))) - 1;
}

void EnvironmentLighting::Add(const EnvironmentLighting& more) {
  if (more.terms() > terms()) radiance_rgb.resize(more.radiance_rgb.size(), {0, 0, 0});
  for (size_t j = 0; j < more.radiance_rgb.size(); ++j) {
    for (size_t c = 0; c < 3; ++c) radiance_rgb[j][c] += more.radiance_rgb[j][c];
  }
}

Vec3d EnvironmentLighting::PlaneIrradiance() const {
  constexpr double kUp[3] = {0, 0, 1};
  return EnvironmentIrradiance(*this, DiffuseHarmonics(kUp));
}

Vec3d EnvironmentLighting::RadianceFrom(const Vec3d& direction) const {
  return EnvironmentIrradiance(
      *this, HarmonicsAt(direction[0], direction[1], direction[2], kEnvironmentDegree));
}

Vec3d EnvironmentIrradiance(const EnvironmentLighting& environment, std::span<const double> terms) {
  Vec3d sum{0, 0, 0};
  for (size_t j = 0; j < environment.radiance_rgb.size(); ++j) {
    for (size_t c = 0; c < 3; ++c) sum[c] += terms[j] * environment.radiance_rgb[j][c];
  }
  return sum;
}

EnvironmentReflection::EnvironmentReflection(const TexelSvbrdf<double>& texel)
    : normal_{texel.normal[0], texel.normal[1], texel.normal[2]},
      diffuse_(DiffuseHarmonics(texel.normal)),
      filter_(SpecularFilter(texel.roughness)) {
  constexpr double kUnseen = 0.002;
  while (specular_degree_ > 0 &&
         std::abs(filter_[static_cast<size_t>(specular_degree_)]) < kUnseen * filter_[0]) {
    --specular_degree_;
  }
}

EnvironmentHarmonics EnvironmentReflection::Specular(const double camera[3], int degree) const {
  const int least = std::min(degree, specular_degree_);
  const double twice = 2 * Dot(normal_, camera);
  return Filtered(HarmonicsAt(twice * normal_[0] - camera[0], twice * normal_[1] - camera[1],
                              twice * normal_[2] - camera[2], least),
                  filter_, least);
}

void EnvironmentReflection::AddTo(const EnvironmentLighting& environment, double exposure,
                                  TexelGeometry<double>* geometry) const {
  if (!environment.any()) return;
  const Vec3d diffuse = EnvironmentIrradiance(environment, diffuse_);
  const Vec3d specular =
      EnvironmentIrradiance(environment, Specular(geometry->camera, environment.degree()));
  for (size_t c = 0; c < 3; ++c) {
    geometry->ambient[c] += exposure * diffuse[c];
    geometry->ambient_specular[c] += exposure * specular[c];
  }
}

}  // namespace glint
