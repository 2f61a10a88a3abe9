#include "fitting/refine/substances.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/cpu/vector_clones.h"
#include "base/model/estimate.h"
#include "base/model/solver.h"
#include "base/model/substances.h"
#include "base/parallel/parallel.h"
#include "fitting/texel/texel_parameters.h"
#include "fitting/view_correction/bounded_step.h"

namespace glint {
namespace {

using constants::kLeastShare;

using Feature = std::array<float, 4>;

float Distance2(const Feature& a, const Feature& b) {
  float sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
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
  Feature mean{};
  for (const Feature& x : features) {
    for (size_t i = 0; i < mean.size(); ++i) mean[i] += x[i] / static_cast<float>(features.size());
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
  for (int iteration = 0; iteration < constants::kClusteringIterations; ++iteration) {
    std::vector<std::array<double, 4>> sums(centres.size());
    std::vector<double> counts(centres.size());
    for (const Feature& x : features) {
      const size_t nearest = Nearest(centres, x);
      for (size_t i = 0; i < x.size(); ++i) sums[nearest][i] += x[i];
      counts[nearest] += 1;
    }
    for (size_t k = 0; k < centres.size(); ++k) {
      if (counts[k] == 0) continue;
      for (size_t i = 0; i < sums[k].size(); ++i) {
        centres[k][i] = static_cast<float>(sums[k][i] / counts[k]);
      }
    }
  }
  return centres;
}

constexpr Eigen::Index kSpecularValues = 3;  // the first of the shared ones

KindsPrior KindsOf(const SubstanceMeans& means) {
  std::vector<SpecularMean> specular;
  for (const SharedValues& m : means.mean) specular.emplace_back(m[0], m[1], m[2]);
  return PriorOfKinds(specular, means.kinds);
}

void AddKinds(const SubstanceMeans& means, Eigen::MatrixXd* information,
              Eigen::VectorXd* gradient) {
  const KindsPrior kinds = KindsOf(means);
  constexpr auto kN = static_cast<Eigen::Index>(kShared);
  const auto count = static_cast<Eigen::Index>(means.mean.size());
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index l = 0; l < count; ++l) {
      information->block<kSpecularValues, kSpecularValues>(kN * k, kN * l) +=
          kinds.information.block<kSpecularValues, kSpecularValues>(kSpecularValues * k,
                                                                    kSpecularValues * l);
    }
    gradient->segment<kSpecularValues>(kN * k) +=
        kinds.gradient.segment<kSpecularValues>(kSpecularValues * k);
  }
}

// Of their errors, row-major by substance and value. A roughness that all share is off by as much
// as the levels among which it was chosen leave open, and other means follow it.
Eigen::MatrixXd CovarianceOfMeans(Eigen::MatrixXd information, const SubstanceMeans& means) {
  const Eigen::Index count = information.rows();
  Eigen::VectorXd common = Eigen::VectorXd::Zero(count);
  if (means.holds_roughness) {
    const auto values = static_cast<Eigen::Index>(kShared);
    for (Eigen::Index i = kSharedRoughness; i < count; i += values) {
      common[i] = constants::kRoughnessLevelSd *
                  means.mean[static_cast<size_t>(i / values)][kSharedRoughness];
    }
    const Eigen::VectorXd pull = information * common;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (common[i] == 0) {
        common[i] = -pull[i];
        continue;
      }
      information.row(i).setZero();
      information.col(i).setZero();
      information(i, i) = 1;
    }
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(information);
  Eigen::MatrixXd covariance = solver.solve(Eigen::MatrixXd::Identity(count, count));
  if (!means.holds_roughness) return covariance;
  for (Eigen::Index i = kSharedRoughness; i < count; i += static_cast<Eigen::Index>(kShared)) {
    covariance(i, i) = 0;
  }
  const Eigen::VectorXd followed = solver.solve(common);
  return covariance + followed * followed.transpose();
}

}  // namespace

Substances::Feature Substances::FeatureOf(const TexelLooks& looks, size_t texel) const {
  std::array<float, 3> logs;
  float mean = 0;
  for (size_t c = 0; c < 3; ++c) {
    const float d = looks.colour[c * looks.colour.size() / 3 + texel];
    logs[c] = std::log(std::max(0.0f, d) + constants::kColourOffset);
    mean += logs[c] / 3;
  }
  return {constants::kBrightnessWeight * mean, constants::kChromaWeight * (logs[0] - mean),
          constants::kChromaWeight * (logs[2] - mean),
          by_gloss_ ? constants::kGlossWeight * looks.gloss[texel] : 0};
}

Substances::Substances(const TexelLooks& looks, int substances, bool by_gloss)
    : by_gloss_(by_gloss) {
  const size_t texels = looks.colour.size() / 3,
               step = std::max<size_t>(1, texels / constants::kClusteredTexels);
  std::vector<Feature> sampled;
  for (size_t i = step / 2; i < texels; i += step) sampled.push_back(FeatureOf(looks, i));
  if (sampled.empty()) sampled.push_back(FeatureOf(looks, 0));
  centres_ = Centres(sampled, substances);
}

std::vector<float> Substances::SharesOf(const TexelLooks& looks, int threads) const {
  constexpr int kTexelsAtOnce = 4096;
  const size_t texels = looks.colour.size() / 3;
  std::vector<float> all(texels * centres_.size());
  ForEachBlock(static_cast<int>(texels), kTexelsAtOnce, threads, [&](int begin, int end) {
    for (auto t = static_cast<size_t>(begin); t < static_cast<size_t>(end); ++t) {
      const Feature x = FeatureOf(looks, t);
      const float least = Distance2(centres_[Nearest(centres_, x)], x);
      float sum = 0;
      float* shares = all.data() + t * centres_.size();
      for (size_t k = 0; k < centres_.size(); ++k) {
        const float d = Distance2(centres_[k], x) - least;
        sum += shares[k] =
            std::exp(-d / (2 * constants::kMembershipWidth * constants::kMembershipWidth));
      }
      for (size_t k = 0; k < centres_.size(); ++k) shares[k] /= sum;
    }
  });
  return all;
}

GLINT_VECTOR_CLONES
SharedValues SubstanceMeans::Of(const float* shares) const {
  SharedValues value{};
  for (size_t k = 0; k < mean.size(); ++k) {
    for (size_t p = 0; p < kShared; ++p) value[p] += shares[k] * mean[k][p];
  }
  return value;
}

SharedCovariance SubstanceMeans::CovarianceOf(const float* shares) const {
  SharedCovariance sum{};
  if (covariance.empty()) return sum;
  const size_t count = mean.size();
  for (size_t k = 0; k < count; ++k) {
    if (shares[k] < kLeastShare) continue;
    for (size_t l = 0; l < count; ++l) {
      if (shares[l] < kLeastShare) continue;
      const double share = static_cast<double>(shares[k]) * shares[l];
      for (size_t p = 0; p < kShared; ++p) {
        const double* row = covariance.data() + (kShared * k + p) * kShared * count + kShared * l;
        for (size_t q = 0; q < kShared; ++q) sum[kShared * p + q] += share * row[q];
      }
    }
  }
  return sum;
}

double SubstanceMeans::LightPower() const {
  double most = 0;
  for (const SharedValues& m : mean) {
    for (size_t p = kAlikeNearby; p < kShared; ++p) most = std::max(most, m[p]);
  }
  return std::max(std::exp(KindsOf(*this).log_power), most / constants::kMostDiffuse);
}

double SubstanceMeans::MetalShare() const { return KindsOf(*this).metal_share; }

SharedValues SubstanceMeans::Variances(const SharedValues& of) const {
  SharedValues variances;
  for (size_t p = 0; p < 3; ++p) {
    const double spread = specular_spread * (of[p] + kSpecularOffset);
    variances[p] = spread * spread;
  }
  variances[kSharedRoughness] = roughness_spread * roughness_spread;
  for (size_t p = 4; p < kShared; ++p) {
    const double spread = diffuse_spread * (of[p] + kSpecularOffset);
    variances[p] = spread * spread;
  }
  return variances;
}

void UpdateMeans(const std::vector<SubstanceSample>& samples, const SampleWorth& worth,
                 SubstanceMeans* means) {
  constexpr int kN = static_cast<int>(kShared);
  using MatrixS = Eigen::Matrix<double, kN, kN, Eigen::RowMajor>;
  using VectorS = Eigen::Matrix<double, kN, 1>;
  const auto count = static_cast<Eigen::Index>(means->mean.size());
  std::vector<MatrixS> blocks(static_cast<size_t>(count * count), MatrixS::Zero());
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(kN * count);
  for (const SubstanceSample& sample : samples) {
    const SharedValues mean = means->Of(sample.shares);
    const SharedValues variances = means->Variances(mean);
    const VectorS precision = Eigen::Map<const VectorS>(variances.data()).cwiseInverse();
    const MatrixS covariance = Eigen::Map<const MatrixS>(sample.covariance.data());
    VectorS departure;
    for (int p = 0; p < kN; ++p) {
      departure[p] = sample.value[static_cast<size_t>(p)] - mean[static_cast<size_t>(p)];
    }
    // The texel's own marginal information about its mean: P − P·C·P.
    MatrixS own = -(precision.asDiagonal() * covariance * precision.asDiagonal());
    own.diagonal() += precision;
    const VectorS pull = precision.cwiseProduct(departure);
    for (Eigen::Index k = 0; k < count; ++k) {
      const double share = sample.shares[k];
      if (share < kLeastShare) continue;
      gradient.segment<kN>(kN * k) += share * pull;
      for (Eigen::Index l = 0; l <= k; ++l) {
        const double other = sample.shares[l];
        if (other < kLeastShare) continue;
        blocks[static_cast<size_t>(count * k + l)] += share * other * own;
      }
    }
  }
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kN * count, kN * count);
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index l = 0; l <= k; ++l) {
      information.block<kN, kN>(kN * k, kN * l) = blocks[static_cast<size_t>(count * k + l)];
    }
  }
  information.triangularView<Eigen::StrictlyUpper>() = information.transpose();
  const Eigen::MatrixXd of_samples = information;
  information *= worth.shared_by_half_vector;
  gradient *= worth.shared_by_half_vector;
  // Roughness and diffuse albedo are expected within a wide range of their common mean.
  SharedValues common{};
  for (const SharedValues& m : means->mean) {
    for (size_t p = 0; p < kShared; ++p) common[p] += m[p] / static_cast<double>(count);
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index p = kSpecularValues; p < kN; ++p) {
      const auto q = static_cast<size_t>(p);
      const double width =
          constants::kBetweenToWithin *
          (q == kSharedRoughness ? constants::kRoughnessSd
                                 : constants::kDiffuseSd * (common[q] + kSpecularOffset));
      const double precision = 1 / (width * width);
      information(kN * k + p, kN * k + p) += precision;
      gradient[kN * k + p] += precision * (common[q] - means->mean[static_cast<size_t>(k)][q]);
    }
  }
  AddKinds(*means, &information, &gradient);
  Eigen::VectorXd least(kN * count), most(kN * count);
  for (Eigen::Index i = 0; i < kN * count; ++i) {
    const double mean = means->mean[static_cast<size_t>(i / kN)][static_cast<size_t>(i % kN)];
    const bool roughness = i % kN == kSharedRoughness;
    const bool held = roughness && means->holds_roughness;
    const double farthest = held ? 0 : constants::kMostMeanStep * (mean + kSpecularOffset);
    least[i] = std::max(-farthest, (roughness ? kRoughnessBounds.low : 0.0) - mean);
    most[i] = std::min(farthest, 1.0 - mean);
  }
  const Eigen::VectorXd step = StepWithin(information, gradient, least, most);
  for (Eigen::Index i = 0; i < kN * count; ++i) {
    means->mean[static_cast<size_t>(i / kN)][static_cast<size_t>(i % kN)] += step[i];
  }
  information += (worth.shared_by_view - worth.shared_by_half_vector) * of_samples;
  const Eigen::MatrixXd covariance = CovarianceOfMeans(std::move(information), *means);
  means->covariance.assign(covariance.data(), covariance.data() + covariance.size());
}

}  // namespace glint
