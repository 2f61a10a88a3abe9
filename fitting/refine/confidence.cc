#include "fitting/refine/confidence.h"

#include <algorithm>
#include <cmath>

#include "base/model/solver.h"

namespace glint {
void TexelCovariance::operator+=(const TexelCovariance& other) {
  for (size_t i = 0; i < variances.size(); ++i) variances[i] += other.variances[i];
  slopes += other.slopes;
}

double LeastInformation(double scale) {
  return scale * scale / (constants::kWidestSd * constants::kWidestSd);
}

TexelCovariance PosteriorCovariance(const BatchInverse& inverse, int lane, double scale) {
  const double variance = scale * scale;
  TexelCovariance covariance;
  for (int i = 0; i < kTexelParameters; ++i) {
    covariance.variances[static_cast<size_t>(i)] = variance * inverse.at(i, i, lane);
  }
  covariance.slopes = variance * inverse.at(kSlopeX, kSlopeY, lane);
  return covariance;
}

TexelCovariance SystematicCovariance(const SystematicDeviations& deviations,
                                     const TexelValues& texel) {
  TexelCovariance covariance;
  const auto set = [&](int parameter, double deviation) {
    covariance.variances[static_cast<size_t>(parameter)] = deviation * deviation;
  };
  for (int c = 0; c < 3; ++c) {
    set(DiffuseParameter(c), deviations.diffuse * texel[static_cast<size_t>(DiffuseParameter(c))]);
    set(SpecularParameter(c),
        deviations.specular * texel[static_cast<size_t>(SpecularParameter(c))]);
  }
  set(kRough, deviations.roughness);
  set(kSlopeX, deviations.slope);
  set(kSlopeY, deviations.slope);
  return covariance;
}

std::array<float, kConfidencePlanes> TexelConfidence(const TexelCovariance& covariance,
                                                     const TexelValues& texel, double squares) {
  // n_x, n_y by the slopes.
  const double x = texel[kSlopeX], y = texel[kSlopeY];
  const double length = 1.0 / std::sqrt(1.0 + x * x + y * y);
  const double nx = x * length, ny = y * length;
  const double by_x[2] = {length * (1.0 - nx * nx), -length * nx * ny};
  const double by_y[2] = {by_x[1], length * (1.0 - ny * ny)};
  const double xx = covariance.variances[kSlopeX], yy = covariance.variances[kSlopeY];
  const auto normal_variance = [&](int axis) {
    return by_x[axis] * by_x[axis] * xx + 2.0 * by_x[axis] * by_y[axis] * covariance.slopes +
           by_y[axis] * by_y[axis] * yy;
  };

  // A variance that rounding made negative, or no number, is one of which nothing is known.
  const auto deviation = [](double v) {
    return static_cast<float>(v > 0 ? std::min(std::sqrt(v), constants::kWidestSd)
                                    : constants::kWidestSd);
  };
  std::array<float, kConfidencePlanes> planes;
  planes[kSigmaNormalX] = deviation(normal_variance(0));
  planes[kSigmaNormalY] = deviation(normal_variance(1));
  planes[kSigmaRoughness] = deviation(covariance.variances[kRough]);
  for (int c = 0; c < 3; ++c) {
    const auto at = [&](int i) { return deviation(covariance.variances[static_cast<size_t>(i)]); };
    planes[kSigmaDiffuseR + c] = at(DiffuseParameter(c));
    planes[kSigmaSpecularR + c] = at(SpecularParameter(c));
  }
  planes[kTexelCost] = static_cast<float>(0.5 * squares);
  return planes;
}

}  // namespace glint
