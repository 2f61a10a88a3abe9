#include "pipeline/export/direction_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "base/parallel/parallel.h"
#include "base/reflectance/log_radiance.h"

namespace glint {
namespace {

constexpr double kMostTilt_deg = 70;
constexpr int kErrorPairs = 100;
constexpr size_t kErrorTexels = 4096;

using Direction = std::array<double, 3>;

// Van der Corput's sequence: the digits of `index` in `base`, mirrored at the point.
double RadicalInverse(int index, int base) {
  double value = 0, digit = 1.0 / base;
  for (; index > 0; index /= base, digit /= base) value += digit * (index % base);
  return value;
}

Direction FromAngles(double sine, double azimuth) {
  return {sine * std::cos(azimuth), sine * std::sin(azimuth),
          std::sqrt(std::max(0.0, 1 - sine * sine))};
}

bool Seen(const Direction& d) { return d[2] > std::cos(kMostTilt_deg * std::numbers::pi / 180); }

// The i-th point of a sequence that fills the pairs evenly; false: below the horizon.
bool HighlightPair(int i, double roughness, DirectionPair* pair) {
  const double u = RadicalInverse(i, 2), alpha = roughness * roughness;
  const double tangent = alpha * std::sqrt(u / (1 - u));
  const Direction half = FromAngles(tangent / std::sqrt(1 + tangent * tangent),
                                    2 * std::numbers::pi * RadicalInverse(i, 3));
  const Direction camera =
      FromAngles(std::sin(kMostTilt_deg * std::numbers::pi / 180) * std::sqrt(RadicalInverse(i, 5)),
                 2 * std::numbers::pi * RadicalInverse(i, 7));
  double dot = 0;
  for (size_t k = 0; k < 3; ++k) dot += half[k] * camera[k];
  Direction light;
  for (size_t k = 0; k < 3; ++k) light[k] = 2 * dot * half[k] - camera[k];
  if (!(dot > 0) || !Seen(light)) return false;
  *pair = MakePair(light, camera);
  return true;
}

DirectionPair AnyPair(int i) {
  const double most = std::sin(kMostTilt_deg * std::numbers::pi / 180);
  return MakePair(FromAngles(most * std::sqrt(RadicalInverse(i, 2)),
                             2 * std::numbers::pi * RadicalInverse(i, 3)),
                  FromAngles(most * std::sqrt(RadicalInverse(i, 5)),
                             2 * std::numbers::pi * RadicalInverse(i, 7)));
}

std::vector<DirectionPair> Pairs(double roughness, int count) {
  std::vector<DirectionPair> pairs;
  DirectionPair pair;
  for (int i = 1; static_cast<int>(pairs.size()) < count / 2; ++i) {
    if (HighlightPair(i, roughness, &pair)) pairs.push_back(pair);
  }
  for (int i = 1; static_cast<int>(pairs.size()) < count; ++i) pairs.push_back(AnyPair(i));
  return pairs;
}

}  // namespace

DirectionPair MakePair(const Direction& light, const Direction& camera) {
  constexpr double kOne[3] = {1, 1, 1}, kNone[3] = {0, 0, 0};
  DirectionPair pair{light, camera, 1, {}};
  pair.geometry = MakeTexelGeometry<double>(light.data(), camera.data(), kOne, kNone);
  pair.v_dot_h = 0;
  for (size_t k = 0; k < 3; ++k) pair.v_dot_h += camera[k] * pair.geometry.half[k];
  return pair;
}

double SmithSpecular(const DirectionPair& pair, const LobeWidths& widths) {
  const double direction_rad = widths.direction_deg * (std::numbers::pi / 180);
  const double cosine = std::cos(direction_rad), sine = std::sin(direction_rad);
  // A direction in the lobe's axes, the first two times α.
  const auto stretched = [&](const double* d) {
    return std::array<double, 3>{widths.along * (cosine * d[0] + sine * d[1]),
                                 widths.across * (cosine * d[1] - sine * d[0]), d[2]};
  };
  const auto length = [](const std::array<double, 3>& d) { return std::hypot(d[0], d[1], d[2]); };
  const double* h = pair.geometry.half;
  const double along = (cosine * h[0] + sine * h[1]) / widths.along;
  const double across = (cosine * h[1] - sine * h[0]) / widths.across;
  const double denominator = along * along + across * across + h[2] * h[2];
  const double distribution =
      1 / (std::numbers::pi * widths.along * widths.across * denominator * denominator);
  const double l = pair.light[2], v = pair.camera[2];
  const double masking =
      l * length(stretched(pair.camera.data())) + v * length(stretched(pair.light.data()));
  return distribution * 0.5 / std::max(masking, 1e-9);
}

double SmithSpecular(const DirectionPair& pair, double roughness, const Anisotropy& anisotropy) {
  return SmithSpecular(pair, WidthsOf(roughness, anisotropy));
}

LobeWidths WidthsOf(double roughness, const Anisotropy& anisotropy) {
  const double alpha = std::pow(std::max(roughness, 0.03), 2), root = std::sqrt(anisotropy.ratio);
  return {std::min(1.0, alpha * root), alpha / root, anisotropy.direction_deg};
}

double SmithSpecular(const DirectionPair& pair, double roughness, const SpecularLobes& lobes) {
  const LobeMix<double> mix = LobeMixOf<double>(lobes);
  double sum = 0;
  for (int i = 0; i < (mix.two && !mix.coat() ? 2 : 1); ++i) {
    sum += mix.share[i] * SmithSpecular(pair, LobeRoughness(roughness, mix, i), lobes.anisotropy);
  }
  return sum;
}

double SmithCoat(const DirectionPair& pair, double roughness, const SpecularLobes& lobes,
                 double schlick_weight) {
  const LobeMix<double> mix = LobeMixOf<double>(lobes);
  if (!mix.coat()) return 0;
  return mix.share[1] * SmithSpecular(pair, LobeRoughness(roughness, mix, 1), lobes.anisotropy) *
         Fresnel(mix.coat_f0, schlick_weight);
}

double SchlickWeight(double cosine) { return std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5); }

std::vector<DirectionPair> PairsForRoughness(double roughness) {
  return Pairs(roughness, kPairsOfRoughness);
}

namespace {

double LogRadiance(double brdf, const DirectionPair& pair) {
  return std::log(std::numbers::pi * pair.light[2] * std::max(brdf, 0.0) + kLogOffset);
}

// Adds up the texel's errors of each shading.
void AddErrors(const SvbrdfMaps& maps, const ReflectanceConvention& convention, size_t i,
               const std::vector<Shading>& shadings, std::span<double> sums) {
  TexelSvbrdf<double> texel{{0, 0, 1}, {}, {}, maps.plane(kRoughness)[i]};
  for (int c = 0; c < 3; ++c) {
    texel.diffuse[c] = maps.plane(kDiffuseR + c)[i];
    texel.specular[c] = maps.plane(kSpecularR + c)[i];
  }
  for (const DirectionPair& pair : Pairs(texel.roughness, kErrorPairs)) {
    double ours[3];
    EvaluateBrdf(texel, pair.geometry, convention, ours);
    for (double& value : ours) value = LogRadiance(value, pair);
    for (size_t s = 0; s < shadings.size(); ++s) {
      const std::array<double, 3> theirs = shadings[s](i, pair);
      for (size_t c = 0; c < 3; ++c) sums[s] += std::abs(LogRadiance(theirs[c], pair) - ours[c]);
    }
  }
}

}  // namespace

std::vector<double> ShadingErrors(const SvbrdfMaps& maps, const ReflectanceConvention& convention,
                                  const std::vector<Shading>& shadings, int threads) {
  const size_t count = std::min(maps.texels(), kErrorTexels), kinds = shadings.size();
  std::vector<double> by_texel(count * kinds, 0.0), errors(kinds, 0.0);
  ForEachBlock(static_cast<int>(count), 64, threads, [&](int begin, int end) {
    for (size_t k = static_cast<size_t>(begin); k < static_cast<size_t>(end); ++k) {
      const size_t texel = (2 * k + 1) * maps.texels() / (2 * count);
      AddErrors(maps, convention, texel, shadings, std::span(by_texel).subspan(k * kinds, kinds));
    }
  });
  for (size_t i = 0; i < by_texel.size(); ++i) errors[i % kinds] += by_texel[i];
  for (double& error : errors) error /= static_cast<double>(3 * kErrorPairs * count);
  return errors;
}

}  // namespace glint
