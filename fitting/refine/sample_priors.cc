// What the model of a sample says of each texel beforehand, and what that leaves uncertain.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/model/initial_maps.h"
#include "base/model/substances.h"
#include "fitting/refine/neighbours.h"
#include "fitting/refine/sample_model.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {

TexelGaussian SampleModel::Initialisation(size_t texel) const {
  const std::span<const float> stated = part_->problem().initial_sd;
  if (!stated.empty() && all_views_.size() < constants::kLeastValidatedViews) {
    const auto of = [&](int plane) {
      return stated[static_cast<size_t>(plane) * part_->texels() + texel];
    };
    std::array<double, kTexelParameters> sd;
    for (int c = 0; c < 3; ++c) {
      sd[static_cast<size_t>(DiffuseParameter(c))] = of(kSigmaDiffuseR + c);
      sd[static_cast<size_t>(SpecularParameter(c))] = of(kSigmaSpecularR + c);
    }
    sd[kRough] = of(kSigmaRoughness);
    sd[kSlopeX] = of(kSigmaNormalX);
    sd[kSlopeY] = of(kSigmaNormalY);
    return TexelGaussian(ReadTexel(part_->initial(), texel), sd);
  }
  return TexelGaussian(ReadTexel(part_->initial(), texel), initial_errors_);
}

void SampleModel::MultiplySubstance(size_t texel, TexelGaussian* gaussian) const {
  const SharedValues mean = means_.Of(part_->shares(texel));
  const SharedValues variances = means_.Variances(mean);
  for (size_t p = 0; p < kShared; ++p) {
    gaussian->Multiply(kSharedParameters[p], mean[p], 1 / variances[p]);
  }
  const double precision = NormalPrecision(texel);
  gaussian->Multiply(kSlopeX, 0, precision);
  gaussian->Multiply(kSlopeY, 0, precision);
}

TexelGaussian SampleModel::Knowledge(size_t texel) const {
  TexelGaussian gaussian = Initialisation(texel);
  MultiplySubstance(texel, &gaussian);
  return gaussian;
}

void SampleModel::MultiplyNeighbours(size_t texel, std::span<const Neighbour> neighbours,
                                     TexelGaussian* gaussian) const {
  if (neighbours.empty()) return;
  double normal[2] = {0, 0};
  SharedValues departure{};  // of the neighbours from their own substances
  const double count = static_cast<double>(neighbours.size());
  for (const Neighbour& neighbour : neighbours) {
    double of_neighbour[2];
    NormalOfSlopes(neighbour.values[kSlopeX], neighbour.values[kSlopeY], of_neighbour);
    for (int i = 0; i < 2; ++i) normal[i] += of_neighbour[i];
    const SharedValues shared = SharedOf(neighbour.values);
    const SharedValues mean = means_.Of(part_->shares(neighbour.texel));
    for (size_t p = 0; p < kAlikeNearby; ++p) departure[p] += shared[p] - mean[p];
  }
  for (int i = 0; i < 2; ++i) {
    gaussian->Multiply(kSlopeX + i, normal[i] / count, count * NormalPrecision(texel));
  }
  const SharedValues mean = means_.Of(part_->shares(texel));
  const SharedValues variances = means_.Variances(mean);
  for (size_t p = 0; p < kAlikeNearby; ++p) {
    gaussian->Multiply(kSharedParameters[p], mean[p] + departure[p] / count,
                       count / (neighbour_spread_ * neighbour_spread_ * variances[p]));
  }
}

TexelPrior SampleModel::Scaled(const TexelGaussian& gaussian,
                               const ResidualModel& residuals) const {
  return TexelPrior(gaussian, residuals.scale() * std::sqrt(options_.prior));
}

TexelPrior SampleModel::PriorOf(size_t texel) const { return Scaled(Knowledge(texel), residuals_); }

TexelPrior SampleModel::StatedPriorOf(size_t texel) const {
  return Scaled(Knowledge(texel), measured_residuals_);
}

TexelPrior SampleModel::PriorOf(size_t texel, const SvbrdfMaps& maps,
                                const ReliefSlope* relief) const {
  std::array<Neighbour, 4> neighbours;
  size_t count = 0;
  ForEachNeighbour(texel, maps.width, maps.height, [&](size_t neighbour) {
    neighbours[count++] = {neighbour, ReadTexel(maps, neighbour)};
  });
  TexelGaussian gaussian = Knowledge(texel);
  MultiplyNeighbours(texel, std::span(neighbours).first(count), &gaussian);
  if (relief != nullptr) {
    double normal[2];
    NormalOfSlopes((*relief)[0], (*relief)[1], normal);
    const double variance =
        constants::kReliefSd * constants::kReliefSd / NormalPrecision(texel) + facet_variance_;
    for (int i = 0; i < 2; ++i) gaussian.Set(kSlopeX + i, normal[i], 1 / variance);
  }
  return Scaled(gaussian, residuals_);
}

// Where the means move by dm, the most probable values move by C·P·dm, with C the texel's posterior
// covariance and P its substances' precisions.
TexelCovariance SampleModel::CommonCovariance(size_t texel, const BatchInverse& inverse,
                                              int lane) const {
  const float* shares = part_->shares(texel);
  const SharedValues variances = means_.Variances(means_.Of(shares));
  const SharedCovariance means = means_.CovarianceOf(shares);
  const double variance = measured_residuals_.scale() * measured_residuals_.scale();
  const auto follows = [&](int value) {
    SharedValues by;
    for (size_t p = 0; p < kShared; ++p) {
      by[p] =
          options_.prior * variance / variances[p] * inverse.at(kSharedParameters[p], value, lane);
    }
    return by;
  };
  const auto covariance = [&](const SharedValues& a, const SharedValues& b) {
    double sum = 0;
    for (size_t p = 0; p < kShared; ++p) {
      double with = 0;
      for (size_t q = 0; q < kShared; ++q) with += means[kShared * p + q] * b[q];
      sum += a[p] * with;
    }
    return sum;
  };
  TexelCovariance common;
  for (int i = 0; i < kTexelParameters; ++i) {
    const SharedValues by = follows(i);
    common.variances[static_cast<size_t>(i)] = covariance(by, by);
  }
  common.slopes = covariance(follows(kSlopeX), follows(kSlopeY));
  return common;
}

// Errors a of variance 1/p (initialisation) and b of 1/q (substance, level surface) have the
// covariance min(1/p, 1/q), so that p·a + q·b, by which the normal equations' right side is off,
// has the variance p + q + 2 min(p, q). M holds the last of it: what is added is C·M·C.
TexelCovariance SampleModel::CorrelatedPriorCovariance(size_t texel, const TexelValues& values,
                                                       const BatchInverse& inverse,
                                                       int lane) const {
  const TexelGaussian initial = Initialisation(texel);
  TexelGaussian expected, common;
  MultiplySubstance(texel, &expected);
  for (int i = 0; i < kTexelParameters; ++i) {
    common.Multiply(i, 0, 2 * std::min(initial.precision(i), expected.precision(i)));
  }
  TexelGram m{};
  Scaled(common, measured_residuals_).AddTo(values, &m);
  const double variance = measured_residuals_.scale() * measured_residuals_.scale();
  const auto covariance = [&](int a, int b) {
    const auto c = [&](int i, int j) { return inverse.at(i, j, lane); };
    double sum =
        m[kSlopeX][kSlopeY] * (c(a, kSlopeX) * c(b, kSlopeY) + c(a, kSlopeY) * c(b, kSlopeX));
    for (int i = 0; i < kTexelParameters; ++i) {
      sum += m[static_cast<size_t>(i)][static_cast<size_t>(i)] * c(a, i) * c(b, i);
    }
    return variance * sum;
  };
  TexelCovariance added;
  for (int i = 0; i < kTexelParameters; ++i) {
    added.variances[static_cast<size_t>(i)] = covariance(i, i);
  }
  added.slopes = covariance(kSlopeX, kSlopeY);
  return added;
}

double SampleModel::NormalPrecision(size_t texel) const {
  double variance = 0;
  for (size_t k = 0; k < normal_spreads_.size(); ++k) {
    const double share = part_->shares(texel)[k];
    if (share > 0) variance += share * normal_spreads_[k] * normal_spreads_[k];
  }
  return 1 / variance;
}

}  // namespace glint
