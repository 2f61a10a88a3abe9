// Substances: places of one reflectance, wherever they lie in the sample (docs/model.md,
// "Reflectance sharing").
//
// A texel belongs to a few substances, by its colour. Its roughness and albedos are those of its
// substances, in the mean, and depart from them by spreads that all substances have in common.
// Means are found from sampled texels by type-II maximum likelihood.
#pragma once

#include <array>
#include <vector>

#include "fitting/reflectance/svbrdf_maps.h"
#include "fitting/texel/texel_prior.h"

namespace glint {

inline constexpr int kMostSubstances = 8;
// Shared values, by their place among a texel's parameters.
inline constexpr size_t kShared = 7;
inline constexpr std::array<int, kShared> kSharedParameters = {
    SpecularParameter(0), SpecularParameter(1), SpecularParameter(2), kRough,
    DiffuseParameter(0),  DiffuseParameter(1),  DiffuseParameter(2)};
inline constexpr size_t kSharedRoughness = 3;  // its place among them
using SharedValues = std::array<double, kShared>;

// Which substances there are, by colour.
class Substances {
 public:
  // `colour`: 3 planes of what each texel reflects away from its highlight. k-means on the
  // logarithms of brightness and chroma; deterministic.
  Substances(const std::vector<float>& colour, int substances);

  int count() const { return static_cast<int>(centres_.size()); }
  // Shares of each texel of such colours, `count()` of them one after the other, sum 1.
  std::vector<float> SharesOf(const std::vector<float>& colour) const;

 private:
  std::vector<std::array<float, 3>> centres_;  // in the space of features
};

// Standard deviations of texels about their substance's mean: of roughness, and of albedos relative
// to mean + kAlbedoOffset.
struct SubstanceSpreads {
  double roughness = 0.1, specular = 0.8, diffuse = 1.0;

  // Of a texel's values about such a mean.
  SharedValues Variances(const SharedValues& mean) const;
};

// What has been learned of them.
struct SubstanceMeans {
  std::vector<SharedValues> mean;
  SubstanceSpreads spreads;

  SharedValues Of(const float* shares) const;
};

// Half of what dielectrics reflect at least: what is nearer to 0 is black to all photographs.
inline constexpr double kAlbedoOffset = 0.02;

// A sampled texel at its most probable values, for estimating means and spreads.
struct SubstanceSample {
  const float* shares = nullptr;
  SharedValues value{};
  // Posterior covariance of the values, row-major.
  std::array<double, kShared * kShared> covariance{};
};

// One Newton step of the means on the marginal likelihood. `worth`: of a sample, in independent
// ones, ≤ 1: model discrepancy is common to the texels of a substance that are seen under like half
// vectors.
void UpdateMeans(const std::vector<SubstanceSample>& samples, double worth, SubstanceMeans* means);

}  // namespace glint
