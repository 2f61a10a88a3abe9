// Substances: places of one reflectance, wherever they lie in the sample (docs/model.md,
// "What is known of a texel beforehand").
//
// A texel belongs to a few substances, by its colour and its gloss. Its roughness and albedos are
// those of its substances, in the mean, and depart from them by a spread that all substances share.
// Means are found from sampled texels by type-II maximum likelihood, but for a roughness that
// cross-validation chose.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "base/model/substances.h"
#include "base/reflectance/svbrdf_maps.h"
#include "fitting/refine/kinds_prior.h"
#include "fitting/texel/texel_prior.h"

namespace glint {

inline constexpr int kMostSubstances = 8;  // that options allow
// Shared values, by their place among a texel's parameters; the first of them are also expected to
// depart from their substances as their neighbours' do.
inline constexpr size_t kShared = 7, kAlikeNearby = 4, kSharedRoughness = 3;
inline constexpr std::array<int, kShared> kSharedParameters = {
    SpecularParameter(0), SpecularParameter(1), SpecularParameter(2), kRough,
    DiffuseParameter(0),  DiffuseParameter(1),  DiffuseParameter(2)};
using SharedValues = std::array<double, kShared>;
inline SharedValues SharedOf(const TexelValues& values) {
  SharedValues shared;
  for (size_t p = 0; p < kShared; ++p) {
    shared[p] = values[static_cast<size_t>(kSharedParameters[p])];
  }
  return shared;
}
using SharedCovariance = std::array<double, kShared * kShared>;  // row-major

// What texels are told apart by.
struct TexelLooks {
  std::vector<float> colour;  // 3 planes: what each texel reflects away from its highlight
  std::vector<float> gloss;   // 1 plane: sample_look.h; may be empty where it is not asked for
};

// Which substances there are, by colour, or by colour and gloss.
class Substances {
 public:
  // k-means on the logarithms of brightness and chroma, and on gloss, which may be empty where it
  // is not asked for; deterministic.
  Substances(const TexelLooks& looks, int substances, bool by_gloss);

  bool by_gloss() const { return by_gloss_; }

  int count() const { return static_cast<int>(centres_.size()); }
  // Shares of each such texel, `count()` of them one after the other, sum 1.
  std::vector<float> SharesOf(const TexelLooks& looks, int threads = 1) const;

 private:
  using Feature = std::array<float, 4>;
  Feature FeatureOf(const TexelLooks& looks, size_t texel) const;

  bool by_gloss_;
  std::vector<Feature> centres_;
};

// Diffuse albedo's before cross-validation, and from too few photographs.
inline constexpr double kUnknownSpread = std::numeric_limits<double>::infinity();

// What has been learned of them.
struct SubstanceMeans {
  std::vector<SharedValues> mean;
  // Standard deviation of texels about their substance's mean: of roughness, and of albedos
  // relative to mean + kSpecularOffset.
  double roughness_spread = constants::kRoughnessSd, specular_spread = constants::kSpecularSd;
  double diffuse_spread = kUnknownSpread;
  // Means of roughness stay as they are, which is one for all; nor is normals' scatter estimated.
  bool holds_roughness = false;
  KindsPriorOptions kinds;

  // The light's power by what substances reflect (KindsPrior::log_power), as far as diffuse albedo
  // lets it be weaker.
  double LightPower() const;

  // Of substances, those that are metals, as probably as they are.
  double MetalShare() const;

  // Covariance of all means' errors, row-major by substance and value; empty: they are certain.
  std::vector<double> covariance;

  SharedValues Of(const float* shares) const;
  // Covariance of that, row-major.
  SharedCovariance CovarianceOf(const float* shares) const;
  // Variances of a texel's values about that.
  SharedValues Variances(const SharedValues& mean) const;
};

// A sampled texel at its most probable values, for estimating means and spreads.
struct SubstanceSample {
  const float* shares = nullptr;
  SharedValues value{};
  // Posterior covariance of the values, row-major.
  SharedCovariance covariance{};
};

// What a sample is worth, in independent ones, ≤ 1, since samples have model discrepancy in common.
struct SampleWorth {
  double shared_by_half_vector;  // where those of like half vectors share it …
  double shared_by_view;         // … and what is a view's own too
};

// One Newton step of the means on the marginal likelihood, each sample worth as much as where half
// vectors share discrepancy, and the covariance of their errors, where views do too.
void UpdateMeans(const std::vector<SubstanceSample>& samples, const SampleWorth& worth,
                 SubstanceMeans* means);

}  // namespace glint
