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
// is the flash's offset (shared_light.h). The mean has a prior at 0, of so many times a
// view's own precision.
constexpr double kMeanPrecision = 1e3;

using TexelMatrix = Eigen::Matrix<double, kTexelParameters, kTexelParameters>;

// A view's deviations, then its shading's gradient along x and y, then what all views share.
constexpr int kOwnUnknowns = kViewDeviations + 2;
constexpr int kUnknowns = kOwnUnknowns + kSharedLightValues;
using UnknownsByTexel = Eigen::Matrix<double, kUnknowns, kTexelParameters>;

struct OwnProducts {
  int view = 0;
  Eigen::Matrix<double, kUnknowns, kUnknowns> squared;
  Eigen::Matrix<double, kUnknowns, 1> by_residual;
  UnknownsByTexel by_values;
};

// Shading is an exposure that depends on the place; what views share are deviations of each.
OwnProducts WithShading(const DeviationProducts& products, const std::array<double, 2>& place) {
  Eigen::Matrix<double, kUnknowns, kViewDeviations> by =
      Eigen::Matrix<double, kUnknowns, kViewDeviations>::Zero();
  by.topRows<kViewDeviations>().setIdentity();
  for (int axis = 0; axis < 2; ++axis) {
    by(kViewDeviations + axis, kLogExposure) = place[static_cast<size_t>(axis)];
  }
  for (int i = 0; i < kSharedLightValues; ++i) {
    for (int j = 0; j < kViewDeviations; ++j) {
      by(kOwnUnknowns + i, j) = products.by_shared[static_cast<size_t>(i)][static_cast<size_t>(j)];
    }
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

// Some unknowns are common to all views: sums over views' unknowns become sums over those that
// are told apart.
Eigen::MatrixXd SharingTheLight(int views) {
  Eigen::MatrixXd sharing =
      Eigen::MatrixXd::Zero(kUnknowns * views, kOwnUnknowns * views + kUnknowns - kOwnUnknowns);
  for (int v = 0; v < views; ++v) {
    for (int i = 0; i < kUnknowns; ++i) {
      const int first = i < kOwnUnknowns ? kOwnUnknowns * v : kOwnUnknowns * (views - 1);
      sharing(kUnknowns * v + i, first + i) = 1;
    }
  }
  return sharing;
}

}  // namespace

DeviationProducts ProductsOf(const BatchResiduals& residuals,
                             std::span<const BatchResiduals> nudged, int view, int lane) {
  using Row = BatchResiduals::Row;
  DeviationProducts of;
  for (int c = 0; c < 3; ++c) {
    const auto at = [&](Row row) { return residuals.at(view, c, row, lane); };
    const double residual = at(Row::kResidual);
    std::array<double, kViewDeviations> by;
    for (size_t i = 0; i < kViewDeviations; ++i) {
      by[i] = (nudged[i].at(view, c, Row::kResidual, lane) - residual) / kDeviationStep;
    }
    const std::pair<int, double> by_values[] = {{DiffuseParameter(c), at(Row::kByDiffuse)},
                                                {SpecularParameter(c), at(Row::kBySpecular)},
                                                {kRough, at(Row::kByRough)},
                                                {kSlopeX, at(Row::kBySlopeX)},
                                                {kSlopeY, at(Row::kBySlopeY)}};
    for (size_t i = 0; i < kViewDeviations; ++i) {
      for (size_t j = 0; j < kViewDeviations; ++j) of.squared[i][j] += by[i] * by[j];
      of.by_residual[i] += by[i] * residual;
      for (const auto& [value, by_value] : by_values) {
        of.by_values[i][static_cast<size_t>(value)] += by[i] * by_value;
      }
    }
  }
  return of;
}

ViewDeviations::ViewDeviations(int views, const DeviationValues& expected,
                               const SharedLightValues& expected_shared)
    : expected_(expected),
      spreads_(expected),
      expected_shared_(expected_shared),
      values_(static_cast<size_t>(views)) {
  const auto wide = [](double e) { return e > 0; };
  // Of one photograph there is no telling.
  any_ = views > 1 && (std::any_of(expected.begin(), expected.end(), wide) ||
                       std::any_of(expected_shared.begin(), expected_shared.end(), wide));
}

void ViewDeviations::Update(std::span<const TexelOfViews> texels, double information) {
  if (!any_) return;
  const int views = static_cast<int>(values_.size());
  const auto own_at = [](int view) { return Eigen::Index{kUnknowns} * view; };
  Eigen::MatrixXd own_hessian = Eigen::MatrixXd::Zero(kUnknowns * views, kUnknowns * views);
  Eigen::VectorXd own_gradient = Eigen::VectorXd::Zero(kUnknowns * views);
  for (const TexelOfViews& texel : texels) {
    std::vector<OwnProducts> own;
    for (const DeviationProducts& products : *texel.products) {
      own.push_back(WithShading(products, texel.place));
    }
    const Eigen::Map<const TexelMatrix> inverse(texel.inverse.data());
    for (const OwnProducts& a : own) {
      const UnknownsByTexel follows = a.by_values * inverse;
      own_gradient.segment<kUnknowns>(own_at(a.view)) -= a.by_residual;
      own_hessian.block<kUnknowns, kUnknowns>(own_at(a.view), own_at(a.view)) += a.squared;
      for (const OwnProducts& b : own) {
        own_hessian.block<kUnknowns, kUnknowns>(own_at(a.view), own_at(b.view)) -=
            follows * b.by_values.transpose();
      }
    }
  }
  const Eigen::MatrixXd sharing = SharingTheLight(views);
  Eigen::MatrixXd hessian = information * sharing.transpose() * own_hessian * sharing;
  Eigen::VectorXd gradient = information * sharing.transpose() * own_gradient;
  const auto at = [](int view, int i) { return Eigen::Index{kOwnUnknowns} * view + i; };
  for (int i = 0; i < kSharedLightValues; ++i) {
    const auto k = static_cast<size_t>(i);
    const double spread = std::max(expected_shared_[k], 1e-6);
    hessian(at(views, i), at(views, i)) += 1 / (spread * spread);
    gradient[at(views, i)] -= shared_[k] / (spread * spread);
  }
  for (int i = 0; i < kOwnUnknowns; ++i) {
    const bool shading = i >= kViewDeviations;
    // From a sample's centre to its edge a view's exposure is expected to be off by as much as the
    // whole view's is: phones' JPEGs are corrected for vignetting to some per cent.
    const double spread =
        std::max(shading ? expected_[kLogExposure] : spreads_[static_cast<size_t>(i)], 1e-6);
    const double precision = 1 / (spread * spread);
    for (int v = 0; v < views; ++v) {
      hessian(at(v, i), at(v, i)) += precision;
      if (shading) continue;
      gradient[at(v, i)] -= precision * values_[static_cast<size_t>(v)][static_cast<size_t>(i)];
      for (int w = 0; w < views; ++w) hessian(at(w, i), at(v, i)) += kMeanPrecision * precision;
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
  for (size_t i = 0; i < kSharedLightValues; ++i) {
    shared_[i] +=
        std::clamp(step[at(views, static_cast<int>(i))], -kMostDeviationStep, kMostDeviationStep);
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
