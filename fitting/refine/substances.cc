#include "fitting/refine/substances.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

// Chroma tells substances apart better than brightness, which shading changes too.
constexpr float kBrightnessWeight = 0.5f, kChromaWeight = 2.0f;
constexpr float kColourOffset = 0.01f;
constexpr float kMembershipWidth = 0.2f;  // of the features, for soft shares
constexpr int kIterations = 40;
constexpr size_t kClustered = 8192;

// Substances are expected to differ from their common mean by so many times what texels of one
// differ from each other …
constexpr double kBetweenToWithin = 2;
// … and specular albedos by channel, relative: metals are coloured.
constexpr double kChroma = 0.6;
constexpr double kMostMeanStep = 0.5;  // of a mean, in one round, relative

using Feature = std::array<float, 3>;

Feature FeatureOf(const std::vector<float>& colour, size_t texel) {
  Feature logs;
  float mean = 0;
  for (size_t c = 0; c < 3; ++c) {
    const float d = colour[c * colour.size() / 3 + texel];
    logs[c] = std::log(std::max(0.0f, d) + kColourOffset);
    mean += logs[c] / 3;
  }
  return {kBrightnessWeight * mean, kChromaWeight * (logs[0] - mean),
          kChromaWeight * (logs[2] - mean)};
}

float Distance2(const Feature& a, const Feature& b) {
  float sum = 0;
  for (size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

size_t Nearest(const std::vector<Feature>& centres, const Feature& x) {
  size_t best = 0;
  float least = std::numeric_limits<float>::max();
  for (size_t k = 0; k < centres.size(); ++k) {
    const float d = Distance2(centres[k], x);
    if (d < least) least = d, best = k;
  }
  return best;
}

// Farthest-point initialisation from the feature nearest the mean, then Lloyd's iterations.
std::vector<Feature> Centres(const std::vector<Feature>& features, int count) {
  Feature mean{0, 0, 0};
  for (const Feature& x : features) {
    for (size_t i = 0; i < 3; ++i) mean[i] += x[i] / static_cast<float>(features.size());
  }
  std::vector<Feature> centres = {features[Nearest(features, mean)]};
  while (static_cast<int>(centres.size()) < count) {
    size_t farthest = 0;
    float most = -1;
    for (size_t i = 0; i < features.size(); ++i) {
      const float d = Distance2(centres[Nearest(centres, features[i])], features[i]);
      if (d > most) most = d, farthest = i;
    }
    if (most <= 0) break;
    centres.push_back(features[farthest]);
  }
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    std::vector<std::array<double, 4>> sums(centres.size(), {0, 0, 0, 0});
    for (const Feature& x : features) {
      auto& sum = sums[Nearest(centres, x)];
      for (size_t i = 0; i < 3; ++i) sum[i] += x[i];
      sum[3] += 1;
    }
    for (size_t k = 0; k < centres.size(); ++k) {
      if (sums[k][3] == 0) continue;
      for (size_t i = 0; i < 3; ++i) centres[k][i] = static_cast<float>(sums[k][i] / sums[k][3]);
    }
  }
  return centres;
}

}  // namespace

Substances::Substances(const std::vector<float>& colour, int substances) {
  const size_t texels = colour.size() / 3, step = std::max<size_t>(1, texels / kClustered);
  std::vector<Feature> sampled;
  for (size_t i = step / 2; i < texels; i += step) sampled.push_back(FeatureOf(colour, i));
  if (sampled.empty()) sampled.push_back(FeatureOf(colour, 0));
  centres_ = Centres(sampled, substances);
}

std::vector<float> Substances::SharesOf(const std::vector<float>& colour) const {
  const size_t texels = colour.size() / 3;
  std::vector<float> all(texels * centres_.size());
  for (size_t t = 0; t < texels; ++t) {
    const Feature x = FeatureOf(colour, t);
    const float least = Distance2(centres_[Nearest(centres_, x)], x);
    float sum = 0;
    float* shares = all.data() + t * centres_.size();
    for (size_t k = 0; k < centres_.size(); ++k) {
      const float d = Distance2(centres_[k], x) - least;
      sum += shares[k] = std::exp(-d / (2 * kMembershipWidth * kMembershipWidth));
    }
    for (size_t k = 0; k < centres_.size(); ++k) shares[k] /= sum;
  }
  return all;
}

SharedValues SubstanceMeans::Of(const float* shares) const {
  SharedValues value{};
  for (size_t k = 0; k < mean.size(); ++k) {
    for (size_t p = 0; p < kShared; ++p) value[p] += shares[k] * mean[k][p];
  }
  return value;
}

SharedValues SubstanceSpreads::Variances(const SharedValues& mean) const {
  SharedValues variances;
  for (size_t p = 0; p < kShared; ++p) {
    const double relative = p < kSharedRoughness ? specular : diffuse;
    const double spread = p == kSharedRoughness ? roughness : relative * (mean[p] + kAlbedoOffset);
    variances[p] = spread * spread;
  }
  return variances;
}

namespace {

constexpr auto kN = static_cast<Eigen::Index>(kShared);
using SharedMatrix = Eigen::Matrix<double, kN, kN, Eigen::RowMajor>;
using SharedVector = Eigen::Matrix<double, kN, 1>;

// Normal equations of all substances' means, kShared of each one after the other.
struct MeanEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
};

// What the texels say of the means.
MeanEquations EquationsOf(const std::vector<SubstanceSample>& samples,
                          const SubstanceMeans& means) {
  const auto count = static_cast<Eigen::Index>(means.mean.size());
  MeanEquations equations{Eigen::MatrixXd::Zero(kN * count, kN * count),
                          Eigen::VectorXd::Zero(kN * count)};
  for (const SubstanceSample& sample : samples) {
    const SharedValues mean = means.Of(sample.shares);
    const SharedValues variances = means.spreads.Variances(mean);
    const SharedVector precision = Eigen::Map<const SharedVector>(variances.data()).cwiseInverse();
    const SharedMatrix covariance = Eigen::Map<const SharedMatrix>(sample.covariance.data());
    // The texel's own marginal information about its mean: P − P·C·P.
    SharedMatrix own = -(precision.asDiagonal() * covariance * precision.asDiagonal());
    own.diagonal() += precision;
    const SharedVector pull =
        precision.cwiseProduct(Eigen::Map<const SharedVector>(sample.value.data()) -
                               Eigen::Map<const SharedVector>(mean.data()));
    for (Eigen::Index k = 0; k < count; ++k) {
      const double share = sample.shares[k];
      if (share < 1e-3) continue;
      equations.gradient.segment<kN>(kN * k) += share * pull;
      for (Eigen::Index l = 0; l < count; ++l) {
        const double other = sample.shares[l];
        if (other >= 1e-3) {
          equations.information.block<kN, kN>(kN * k, kN * l) += share * other * own;
        }
      }
    }
  }
  return equations;
}

// Means are expected within a wide range of their common mean.
void HoldToCommonMean(const SubstanceMeans& means, MeanEquations* equations) {
  const auto count = static_cast<Eigen::Index>(means.mean.size());
  SharedValues common{};
  for (const SharedValues& m : means.mean) {
    for (size_t p = 0; p < kShared; ++p) common[p] += m[p] / static_cast<double>(count);
  }
  const SharedValues variances = SubstanceSpreads().Variances(common);
  for (Eigen::Index k = 0; k < count; ++k) {
    for (size_t p = 0; p < kShared; ++p) {
      const Eigen::Index i = kN * k + static_cast<Eigen::Index>(p);
      const double precision = 1 / (kBetweenToWithin * kBetweenToWithin * variances[p]);
      equations->information(i, i) += precision;
      equations->gradient[i] += precision * (common[p] - means.mean[static_cast<size_t>(k)][p]);
    }
  }
}

// … and specular albedos of a substance to be alike in all channels.
void HoldToGrey(const SubstanceMeans& means, MeanEquations* equations) {
  for (size_t k = 0; k < means.mean.size(); ++k) {
    const SharedValues& m = means.mean[k];
    const double grey = (m[0] + m[1] + m[2]) / 3;
    const double width = kChroma * (grey + kAlbedoOffset);
    const Eigen::Index first = kN * static_cast<Eigen::Index>(k);
    for (Eigen::Index p = 0; p < 3; ++p) {
      for (Eigen::Index q = 0; q < 3; ++q) {
        equations->information(first + p, first + q) +=
            ((p == q ? 1.0 : 0.0) - 1.0 / 3) / (width * width);
      }
      equations->gradient[first + p] += (grey - m[static_cast<size_t>(p)]) / (width * width);
    }
  }
}

}  // namespace

void UpdateMeans(const std::vector<SubstanceSample>& samples, double worth, SubstanceMeans* means) {
  MeanEquations equations = EquationsOf(samples, *means);
  equations.information *= worth;
  equations.gradient *= worth;
  HoldToCommonMean(*means, &equations);
  HoldToGrey(*means, &equations);
  const Eigen::VectorXd step = equations.information.ldlt().solve(equations.gradient);
  for (size_t i = 0; i < means->mean.size() * kShared; ++i) {
    const size_t p = i % kShared;
    double& mean = means->mean[i / kShared][p];
    const double most = kMostMeanStep * (mean + kAlbedoOffset);
    mean += std::clamp(step[static_cast<Eigen::Index>(i)], -most, most);
    mean = std::clamp(mean, p == kSharedRoughness ? kRoughnessBounds.low : 0.0, 1.0);
  }
}

}  // namespace glint
