#include "pipeline/export/kind_costs.h"

#include <algorithm>
#include <cmath>

#include "base/reflectance/material_kinds.h"

namespace glint {
namespace {

// Of captures whose light nobody calibrated, F0 is known up to the light's power, within a half.
constexpr double kLogPowerSpread = 0.5;
constexpr double kBlack = 0.002;  // what counts as no F0 at all
// Standard deviation of channels about their mean, relative, of what has no colour and of what has
// one. A fifth is what maps show of it where the diffuse light beneath has one.
constexpr double kGreyChroma = 0.2, kColouredChroma = 0.6;
// Mean of an exponential distribution of diffuse albedo. Metals have none; maps leave a little.
constexpr double kDielectricDiffuse = 0.2, kMetalDiffuse = 0.02;

// Two of the departures are free.
double ChromaDensity(double chroma, double spread) {
  const double off = chroma / spread;
  return std::exp(-0.5 * off * off) / (spread * spread);
}

double Mixed(double metalness, double dielectric, double metal) {
  return (1 - metalness) * dielectric + metalness * metal;
}

}  // namespace

KindLook KindLookOf(const std::array<float, 3>& diffuse, const std::array<float, 3>& specular) {
  KindLook look;
  look.f0 = (specular[0] + specular[1] + specular[2]) / 3;
  look.diffuse = (diffuse[0] + diffuse[1] + diffuse[2]) / 3;
  for (const float channel : specular) {
    const float off = (channel - look.f0) / (look.f0 + static_cast<float>(kSpecularOffset));
    look.chroma += off * off;
  }
  look.chroma = std::sqrt(look.chroma);
  return look;
}

KindCosts::KindCosts(const std::vector<double>& metalnesses, double metal_share) {
  const double of_dielectric = std::hypot(kDielectric.log_spread, kLogPowerSpread);
  const double of_metal = std::hypot(kMetal.log_spread, kLogPowerSpread);
  for (const double m : metalnesses) {
    const double f0 = Mixed(m, kDielectric.f0, kMetal.f0);
    const double spread =
        Mixed(m, kDielectric.f0 * of_dielectric, kMetal.f0 * of_metal) / f0;  // of the logarithm
    const double coloured =
        Mixed(m * kMetal.f0 / f0, kDielectric.coloured_share, kMetal.coloured_share);
    const double diffuse = Mixed(m, kDielectricDiffuse, kMetalDiffuse);
    const double constant = std::log(spread) + std::log(diffuse) -
                            Mixed(m, std::log(1 - metal_share), std::log(metal_share));
    Row& row = rows_.emplace_back();
    row.by_diffuse = static_cast<float>(1 / diffuse);
    for (size_t step = 0; step < kSteps; ++step) {
      const double share = static_cast<double>(step) / (kSteps - 1);
      const double off = std::log((share * share + kBlack) / (f0 + kBlack)) / spread;
      row.by_f0[step] = static_cast<float>(0.5 * off * off + constant);
      const double chroma = share * kMostChroma;
      row.by_chroma[step] = static_cast<float>(-std::log(Mixed(
          coloured, ChromaDensity(chroma, kGreyChroma), ChromaDensity(chroma, kColouredChroma))));
    }
  }
}

}  // namespace glint
