#include "pipeline/export/best_base_color.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/cpu/vector_clones.h"
#include "base/reflectance/brdf.h"
#include "base/reflectance/log_radiance.h"

namespace glint {
namespace {

constexpr double kDielectricF0 = 0.04;  // glTF's

// Of log radiance; errors below count as squares, larger ones as they are: a highlight that the
// target cannot have is not to spoil what it can.
constexpr float kRobustScale = 0.05f;
constexpr int kReweightings = 4;

using Row = PairTerms::Row;
using Lanes = std::array<float, PairTerms::kLanes>;

struct Radiances {
  alignas(64) Row ours, slopes, rests;  // 0.01 added to ours and rests
};

float Sum(const Lanes& lanes) {
  float sum = 0;
  for (const float lane : lanes) sum += lane;
  return sum;
}

}  // namespace

LinearInBase DielectricReflectance(double lobe, double fresnel) {
  const double f = kDielectricF0 + (1 - kDielectricF0) * fresnel;
  return {(1 - f) / std::numbers::pi, lobe * f};
}

LinearInBase MetalReflectance(double lobe, double fresnel) {
  return {lobe * (1 - fresnel), lobe * fresnel};
}

PairTerms TermsOf(double roughness, const SpecularLobes& lobes) {
  const std::vector<DirectionPair> pairs = PairsForRoughness(roughness);
  const TexelSvbrdf<double> texel{{0, 0, 1}, {0, 0, 0}, {0, 0, 0}, roughness};
  PairTerms terms;
  for (size_t i = 0; i < pairs.size(); ++i) {
    const DirectionPair& pair = pairs[i];
    const double received = std::numbers::pi * pair.light[2];
    const MixTerms<double> mix = EvaluateMix(texel, pair.geometry, lobes);
    const double power = pair.geometry.fresnel;
    const double ours = received * mix.over_cosine;
    const double coat = received * mix.coat_over_cosine * Fresnel(lobes.coat_f0, power);
    terms.matte[i] = static_cast<float>(received / std::numbers::pi);
    terms.mirror[i] = static_cast<float>(ours * (1 - power));
    terms.rim[i] = static_cast<float>(ours * power + coat);
    const double lobe = SmithSpecular(pair, roughness), fresnel = SchlickWeight(pair.v_dot_h);
    const LinearInBase dielectric = DielectricReflectance(lobe, fresnel);
    const LinearInBase metal = MetalReflectance(lobe, fresnel);
    terms.dielectric_slope[i] = static_cast<float>(received * dielectric.slope);
    terms.dielectric_rest[i] = static_cast<float>(received * dielectric.rest);
    terms.metal_slope[i] = static_cast<float>(received * metal.slope);
    terms.metal_rest[i] = static_cast<float>(received * metal.rest);
  }
  return terms;
}

// Sums go by lane first: in one order, whatever the vector unit.
GLINT_VECTOR_CLONES
BestBase BestBaseColor(const PairTerms& pairs, float metallic, float diffuse, float specular) {
  constexpr auto kOffset = static_cast<float>(kLogOffset);
  constexpr size_t kLanes = PairTerms::kLanes, kPadded = PairTerms::kPadded;
  Radiances of;
  alignas(64) Row weights;
  for (size_t i = 0; i < kPadded; ++i) {
    const float dielectric_slope = pairs.dielectric_slope[i];
    const float dielectric_rest = pairs.dielectric_rest[i];
    of.ours[i] = diffuse * pairs.matte[i] + specular * pairs.mirror[i] + pairs.rim[i] + kOffset;
    of.slopes[i] = dielectric_slope + metallic * (pairs.metal_slope[i] - dielectric_slope);
    of.rests[i] = dielectric_rest + metallic * (pairs.metal_rest[i] - dielectric_rest) + kOffset;
    weights[i] = 1 / (of.ours[i] * of.ours[i]);
  }
  BestBase best;
  for (int round = 0; round < kReweightings; ++round) {
    alignas(64) Lanes squares{}, products{}, errors{};
    for (size_t i = 0; i < kPadded; i += kLanes) {
      for (size_t lane = 0; lane < kLanes; ++lane) {
        const float slope = of.slopes[i + lane], weighted = weights[i + lane] * slope;
        squares[lane] += weighted * slope;
        products[lane] += weighted * (of.ours[i + lane] - of.rests[i + lane]);
      }
    }
    const float base = std::clamp(Sum(products) / std::max(Sum(squares), 1e-12f), 0.0f, 1.0f);
    for (size_t i = 0; i < kPadded; i += kLanes) {
      for (size_t lane = 0; lane < kLanes; ++lane) {
        // 2(x − 1)/(x + 1) is log x to third order.
        const float theirs = base * of.slopes[i + lane] + of.rests[i + lane];
        const float per_mean = 2 / (theirs + of.ours[i + lane]);
        const float off = (theirs - of.ours[i + lane]) * per_mean;
        const float size = std::sqrt(off * off + kRobustScale * kRobustScale);
        weights[i + lane] = per_mean * per_mean / size;
        errors[lane] += size - kRobustScale;
      }
    }
    best = {base, Sum(errors) / kPairsOfRoughness};
  }
  return best;
}

}  // namespace glint
