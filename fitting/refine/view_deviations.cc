#include "fitting/refine/view_deviations.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace glint {
namespace {

// Views that the expected spreads are worth when they are estimated.
constexpr double kExpectedViews = 2;
constexpr double kMostDeviationStep = 0.2;  // of a deviation, in one step
// What all views share is no deviation of theirs: exposures' mean is the albedos', and the lights'
// is the flash's offset (flash_offset.h). The mean is held to 0 by so many times a view's own
// precision.
constexpr double kHeldMean = 1e3;

// Of the logarithm of radiance, from a sample's centre to its edge, in one view. A choice: phones'
// JPEGs are corrected for vignetting to some per cent.
constexpr double kShadingGradient = 0.1;

using TexelMatrix = Eigen::Matrix<double, kTexelParameters, kTexelParameters>;

// A view's deviations, then its shading's gradient along x and y.
constexpr int kUnknowns = kViewDeviations + 2;
using UnknownsByTexel = Eigen::Matrix<double, kUnknowns, kTexelParameters>;

struct OwnProducts {
  int view = 0;
  Eigen::Matrix<double, kUnknowns, kUnknowns> squared;
  Eigen::Matrix<double, kUnknowns, 1> by_residual;
  UnknownsByTexel by_values;
};

// Shading is an exposure that depends on the place.
OwnProducts WithShading(const DeviationProducts& products, const std::array<double, 2>& place) {
  Eigen::Matrix<double, kUnknowns, kViewDeviations> by =
      Eigen::Matrix<double, kUnknowns, kViewDeviations>::Zero();
  by.topRows<kViewDeviations>().setIdentity();
  for (int axis = 0; axis < 2; ++axis) {
    by(kViewDeviations + axis, kLogExposure) = place[static_cast<size_t>(axis)];
  }
  Eigen::Matrix<double, kViewDeviations, kViewDeviations> squared;
  Eigen::Matrix<double, kViewDeviations, 1> by_residual;
  Eigen::Matrix<double, kViewDeviations, kTexelParameters> by_values;
  for (int i = 0; i < kViewDeviations; ++i) {
    const auto p = static_cast<size_t>(i);
    by_residual[i] = products.by_residual[p];
    for (int j = 0; j < kViewDeviations; ++j) {
      squared(i, j) = products.squared[p][static_cast<size_t>(j)];
    }
    for (int j = 0; j < kTexelParameters; ++j) {
      by_values(i, j) = products.by_values[p][static_cast<size_t>(j)];
    }
  }
  return {products.view, by * squared * by.transpose(), by * by_residual, by * by_values};
}

}  // namespace

std::vector<DeviationProducts> ProductsOf(const KernelRows& rows,
                                          std::span<const std::vector<double>> nudged,
                                          std::span<const int> views) {
  std::vector<DeviationProducts> products(views.size());
  for (size_t v = 0; v < views.size(); ++v) {
    DeviationProducts& of = products[v];
    of.view = views[v];
    for (int c = 0; c < 3; ++c) {
      const double residual = rows.row(c, KernelRows::kResidual)[v];
      std::array<double, kViewDeviations> by;
      for (size_t i = 0; i < kViewDeviations; ++i) {
        by[i] = (nudged[i][static_cast<size_t>(c) * views.size() + v] - residual) / kDeviationStep;
      }
      const std::pair<int, KernelRows::Row> values[] = {
          {DiffuseParameter(c), KernelRows::kByDiffuse},
          {SpecularParameter(c), KernelRows::kBySpecular},
          {kRough, KernelRows::kByRough},
          {kSlopeX, KernelRows::kBySlopeX},
          {kSlopeY, KernelRows::kBySlopeY}};
      for (size_t i = 0; i < kViewDeviations; ++i) {
        for (size_t j = 0; j < kViewDeviations; ++j) of.squared[i][j] += by[i] * by[j];
        of.by_residual[i] += by[i] * residual;
        for (const auto& [value, row] : values) {
          of.by_values[i][static_cast<size_t>(value)] += by[i] * rows.row(c, row)[v];
        }
      }
    }
  }
  return products;
}

ViewDeviations::ViewDeviations(int views, const DeviationValues& expected)
    : expected_(expected), spreads_(expected), values_(static_cast<size_t>(views)) {
  // Of one photograph there is no telling.
  any_ = views > 1 && std::any_of(expected.begin(), expected.end(), [](double e) { return e > 0; });
}

void ViewDeviations::Update(std::span<const TexelOfViews> texels, double information) {
  if (!any_) return;
  const int views = static_cast<int>(values_.size());
  const auto at = [](int view, int i) { return static_cast<Eigen::Index>(kUnknowns * view + i); };
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(kUnknowns * views, kUnknowns * views);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(kUnknowns * views);
  for (const TexelOfViews& texel : texels) {
    std::vector<OwnProducts> own;
    for (const DeviationProducts& products : *texel.products) {
      own.push_back(WithShading(products, texel.place));
    }
    const Eigen::Map<const TexelMatrix> inverse(texel.inverse.data());
    for (const OwnProducts& a : own) {
      const UnknownsByTexel follows = a.by_values * inverse;
      gradient.segment<kUnknowns>(at(a.view, 0)) -= a.by_residual;
      hessian.block<kUnknowns, kUnknowns>(at(a.view, 0), at(a.view, 0)) += a.squared;
      for (const OwnProducts& b : own) {
        hessian.block<kUnknowns, kUnknowns>(at(a.view, 0), at(b.view, 0)) -=
            follows * b.by_values.transpose();
      }
    }
  }
  hessian *= information;
  gradient *= information;
  for (int i = 0; i < kUnknowns; ++i) {
    const bool shading = i >= kViewDeviations;
    const double spread =
        shading ? kShadingGradient : std::max(spreads_[static_cast<size_t>(i)], 1e-6);
    const double precision = 1 / (spread * spread);
    for (int v = 0; v < views; ++v) {
      hessian(at(v, i), at(v, i)) += precision;
      if (shading) continue;
      gradient[at(v, i)] -= precision * values_[static_cast<size_t>(v)][static_cast<size_t>(i)];
      for (int w = 0; w < views; ++w) hessian(at(w, i), at(v, i)) += kHeldMean * precision;
    }
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(hessian);
  const Eigen::VectorXd step = solver.solve(gradient);
  const Eigen::MatrixXd covariance =
      solver.solve(Eigen::MatrixXd::Identity(hessian.rows(), hessian.cols()));
  std::vector<DeviationValues> variances(values_.size());
  for (int v = 0; v < views; ++v) {
    const auto k = static_cast<size_t>(v);
    for (int i = 0; i < kViewDeviations; ++i) {
      values_[k][static_cast<size_t>(i)] +=
          std::clamp(step[at(v, i)], -kMostDeviationStep, kMostDeviationStep);
      variances[k][static_cast<size_t>(i)] = covariance(at(v, i), at(v, i));
    }
  }
  UpdateSpreads(variances);
}

void ViewDeviations::UpdateSpreads(const std::vector<DeviationValues>& variances) {
  for (size_t i = 0; i < kViewDeviations; ++i) {
    double squares = kExpectedViews * expected_[i] * expected_[i];
    for (size_t v = 0; v < values_.size(); ++v) {
      squares += values_[v][i] * values_[v][i] + variances[v][i];
    }
    if (expected_[i] > 0) {
      spreads_[i] = std::sqrt(squares / (kExpectedViews + static_cast<double>(values_.size())));
    }
  }
}

}  // namespace glint
