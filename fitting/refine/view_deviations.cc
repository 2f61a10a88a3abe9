#include "fitting/refine/view_deviations.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/model/solver.h"
#include "base/model/uncalibrated_light.h"
#include "base/parallel/parallel.h"

namespace glint {
namespace {

using constants::kLeastViewSd;
using constants::kMostDeviationStep;

// At −1 the curve would be level at black, and fall beyond it.
constexpr double kLeastShoulder = -0.9;

using TexelMatrix = Eigen::Matrix<double, kTexelParameters, kTexelParameters>;

// A view's deviations, then its shading's gradient along x and y, then what all views share. Each
// is some times one deviation of the view: shading is an exposure that depends on the place.
constexpr int kOwnUnknowns = kViewDeviations + 2;
constexpr int kUnknowns = kOwnUnknowns + kSharedLightValues;

size_t DeviationOf(int unknown) {
  if (unknown < kViewDeviations) return static_cast<size_t>(unknown);
  if (unknown < kOwnUnknowns) return kLogExposure;
  return DeviationBy(static_cast<SharedLightValue>(unknown - kOwnUnknowns));
}

// Which of the unknowns are unknown, and where each stands among those of all views.
class UnknownsOfViews {
 public:
  struct Unknown {
    int kind = 0;
    size_t deviation = 0;
  };

  UnknownsOfViews(int views, const DeviationValues& expected,
                  const SharedLightValues& expected_shared)
      : views_(views) {
    for (int i = 0; i < kViewDeviations; ++i) {
      if (expected[static_cast<size_t>(i)] > 0) own_.push_back(i);
    }
    // A view's shading varies where its exposure does.
    if (expected[kLogExposure] > 0) own_.insert(own_.end(), {kViewDeviations, kViewDeviations + 1});
    for (int i = 0; i < kSharedLightValues; ++i) {
      if (expected_shared[static_cast<size_t>(i)] > 0) shared_.push_back(i);
    }
    for (const int i : own_) of_view_.push_back({i, DeviationOf(i)});
    for (const int i : shared_) {
      of_view_.push_back({kOwnUnknowns + i, DeviationOf(kOwnUnknowns + i)});
    }
  }

  const std::vector<int>& own() const { return own_; }
  const std::vector<int>& shared() const { return shared_; }
  // All that one view depends on: its own, then what is shared.
  const std::vector<Unknown>& of_view() const { return of_view_; }
  Eigen::Index at(int view, size_t own) const {
    return static_cast<Eigen::Index>(own_.size()) * view + static_cast<Eigen::Index>(own);
  }
  Eigen::Index at_shared(size_t shared) const {
    return at(views_, 0) + static_cast<Eigen::Index>(shared);
  }
  // Of one in of_view().
  Eigen::Index PlaceOf(int view, size_t i) const {
    return i < own_.size() ? at(view, i) : at_shared(i - own_.size());
  }
  Eigen::Index size() const { return at_shared(shared_.size()); }

 private:
  int views_;
  std::vector<int> own_, shared_;
  std::vector<Unknown> of_view_;
};

// The views' normal equations, texels eliminated.
struct ViewEquations {
  Eigen::MatrixXd hessian;  // its lower triangle, until Complete()
  Eigen::VectorXd gradient;
  // The sample's mean slope, along x and y, and how it follows the views.
  Eigen::Vector2d mean_slope = Eigen::Vector2d::Zero();
  Eigen::MatrixXd mean_slope_by_views;

  explicit ViewEquations(Eigen::Index unknowns)
      : hessian(Eigen::MatrixXd::Zero(unknowns, unknowns)),
        gradient(Eigen::VectorXd::Zero(unknowns)),
        mean_slope_by_views(Eigen::MatrixXd::Zero(2, unknowns)) {}

  // What some texels tell, each of which is a `share` of all. Texels' products with all unknowns
  // are gathered, a block of texels at a time, for one product of matrices.
  void Add(const UnknownsOfViews& unknowns, std::span<const TexelOfViews> texels, double share) {
    constexpr size_t kBlockOfTexels = 32;
    constexpr Eigen::Index kRows = kBlockOfTexels * kTexelParameters;
    Eigen::MatrixXd by_values(kRows, unknowns.size()), follows(kRows, unknowns.size());
    for (size_t first = 0; first < texels.size(); first += kBlockOfTexels) {
      by_values.setZero();
      follows.setZero();
      const size_t count = std::min(kBlockOfTexels, texels.size() - first);
      for (size_t t = 0; t < count; ++t) {
        const Eigen::Index row = static_cast<Eigen::Index>(t) * kTexelParameters;
        const TexelOfViews& texel = texels[first + t];
        Add(unknowns, texel, row, &by_values);
        const Eigen::Map<const TexelMatrix> inverse(texel.inverse);
        follows.middleRows<kTexelParameters>(row).noalias() =
            inverse * by_values.middleRows<kTexelParameters>(row);
        mean_slope += share * Eigen::Vector2d(texel.slope[0], texel.slope[1]);
        mean_slope_by_views -= share * follows.middleRows<2>(row + kSlopeX);
      }
      hessian.triangularView<Eigen::Lower>() -= by_values.transpose() * follows;
    }
  }

  void operator+=(const ViewEquations& other) {
    hessian += other.hessian;
    gradient += other.gradient;
    mean_slope += other.mean_slope;
    mean_slope_by_views += other.mean_slope_by_views;
  }

  void Complete() { hessian.triangularView<Eigen::StrictlyUpper>() = hessian.transpose(); }

 private:
  void Add(const UnknownsOfViews& unknowns, const TexelOfViews& texel, Eigen::Index row,
           Eigen::MatrixXd* by_values) {
    const auto& of_view = unknowns.of_view();
    for (const DeviationProducts& products : *texel.products) {
      std::array<double, kUnknowns> by;
      for (size_t i = 0; i < of_view.size(); ++i) by[i] = Times(of_view[i].kind, products, texel);
      for (size_t i = 0; i < of_view.size(); ++i) {
        const size_t own = of_view[i].deviation;
        const Eigen::Index at = unknowns.PlaceOf(products.view, i);
        gradient[at] -= by[i] * products.by_residual[own];
        for (size_t k = 0; k < kTexelParameters; ++k) {
          (*by_values)(row + static_cast<Eigen::Index>(k), at) +=
              by[i] * products.by_values[own][k];
        }
        for (size_t j = 0; j <= i; ++j) {
          hessian(at, unknowns.PlaceOf(products.view, j)) +=
              by[i] * by[j] * products.squared[own][of_view[j].deviation];
        }
      }
    }
  }

  // An unknown's part of its deviation.
  static double Times(int unknown, const DeviationProducts& products, const TexelOfViews& texel) {
    if (unknown < kViewDeviations) return 1;
    if (unknown < kOwnUnknowns) return texel.place[static_cast<size_t>(unknown - kViewDeviations)];
    return products.by_shared[static_cast<size_t>(unknown - kOwnUnknowns)];
  }
};

// Blocks of texels, summed in their order.
ViewEquations EquationsOf(const UnknownsOfViews& unknowns, std::span<const TexelOfViews> texels,
                          int threads) {
  constexpr int kTexelsOfBlock = 256;
  const int count = static_cast<int>(texels.size());
  const double share = 1.0 / count;
  std::vector<ViewEquations> of_blocks(
      static_cast<size_t>((count + kTexelsOfBlock - 1) / kTexelsOfBlock),
      ViewEquations(unknowns.size()));
  ForEachBlock(count, kTexelsOfBlock, threads, [&](int begin, int end) {
    of_blocks[static_cast<size_t>(begin / kTexelsOfBlock)].Add(
        unknowns, texels.subspan(static_cast<size_t>(begin), static_cast<size_t>(end - begin)),
        share);
  });
  ViewEquations sum(unknowns.size());
  for (const ViewEquations& of_block : of_blocks) sum += of_block;
  sum.Complete();
  return sum;
}

}  // namespace

DeviationProducts ProductsOf(const BatchResiduals& residuals,
                             std::span<const BatchResiduals> nudged,
                             const UnknownDeviations& unknown, int view, int lane) {
  using Row = BatchResiduals::Row;
  DeviationProducts of;
  for (int c = 0; c < 3; ++c) {
    const auto at = [&](Row row) { return residuals.at(view, c, row, lane); };
    const double residual = at(Row::kResidual);
    std::array<double, kViewDeviations> by{};
    for (size_t i = 0; i < kViewDeviations; ++i) {
      if (!unknown[i]) continue;
      by[i] = (nudged[i].at(view, c, Row::kResidual, lane) - residual) / constants::kDeviationStep;
    }
    const std::pair<int, double> by_values[] = {{DiffuseParameter(c), at(Row::kByDiffuse)},
                                                {SpecularParameter(c), at(Row::kBySpecular)},
                                                {kRough, at(Row::kByRough)},
                                                {kSlopeX, at(Row::kBySlopeX)},
                                                {kSlopeY, at(Row::kBySlopeY)}};
    for (size_t i = 0; i < kViewDeviations; ++i) {
      for (size_t j = 0; j < kViewDeviations; ++j)
        of.squared[i][j] += static_cast<float>(by[i] * by[j]);
      of.by_residual[i] += static_cast<float>(by[i] * residual);
      for (const auto& [value, by_value] : by_values) {
        of.by_values[i][static_cast<size_t>(value)] += static_cast<float>(by[i] * by_value);
      }
    }
  }
  return of;
}

ViewDeviations::ViewDeviations(int views, const DeviationValues& expected,
                               const SharedLightValues& expected_shared, LampsExpected lamps)
    : expected_(expected),
      spreads_(expected),
      expected_shared_(expected_shared),
      lamps_(std::move(lamps)),
      values_(static_cast<size_t>(views)) {
  const auto wide = [](double e) { return e > 0; };
  // Of one photograph there is no telling.
  any_ = views > 1 && (std::any_of(expected.begin(), expected.end(), wide) ||
                       std::any_of(expected_shared.begin(), expected_shared.end(), wide));
}

UnknownDeviations ViewDeviations::unknown() const {
  UnknownDeviations unknown{};
  for (size_t i = 0; i < kViewDeviations; ++i) unknown[i] = any_ && expected_[i] > 0;
  const SharedLightValues expected = ExpectedOfShared();
  for (int k = 0; k < kSharedLightValues; ++k) {
    bool& one = unknown[DeviationBy(static_cast<SharedLightValue>(k))];
    one = one || (any_ && expected[static_cast<size_t>(k)] > 0);
  }
  return unknown;
}

SharedLightValues ViewDeviations::ExpectedOfShared() const {
  SharedLightValues expected = expected_shared_;
  if (curve_held_) expected[kSharedToe] = expected[kSharedShoulder] = 0;
  return expected;
}

bool ViewDeviations::finds_curve() const {
  return any_ && (expected_shared_[kSharedToe] > 0 || expected_shared_[kSharedShoulder] > 0);
}

void ViewDeviations::HoldCurve(bool hold) {
  curve_held_ = hold;
  last_step_ = {};
}

// Dark texels tell much of a small toe and little of a large one, so that Newton's steps go back
// and forth between them: one that turns back is half as long as the last at most, others twice as
// long.
double ViewDeviations::CurveStep(size_t shared, double newton) {
  double& last = last_step_[shared];
  double most = kMostDeviationStep;
  if (last != 0) most = std::min(most, std::abs(last) * (newton * last < 0 ? 0.5 : 2));
  last = std::clamp(newton, -most, most);
  return last;
}

void ViewDeviations::Update(std::span<const TexelOfViews> texels, double information, int threads) {
  if (!any_) return;
  const int views = static_cast<int>(values_.size());
  const UnknownsOfViews unknowns(views, expected_, ExpectedOfShared());
  if (unknowns.size() == 0) return;
  ViewEquations equations = EquationsOf(unknowns, texels, threads);
  Eigen::MatrixXd& hessian = equations.hessian;
  Eigen::VectorXd& gradient = equations.gradient;
  hessian *= information;
  gradient *= information;
  if (lamps_.level > 0) {
    const double precision = 1 / (lamps_.level * lamps_.level);
    const Eigen::MatrixXd& by_views = equations.mean_slope_by_views;
    hessian += precision * by_views.transpose() * by_views;
    gradient -= precision * by_views.transpose() * equations.mean_slope;
  }
  for (size_t i = 0; i < unknowns.shared().size(); ++i) {
    const auto k = static_cast<size_t>(unknowns.shared()[i]);
    const double precision = 1 / (expected_shared_[k] * expected_shared_[k]);
    const Eigen::Index at = unknowns.at_shared(i);
    hessian(at, at) += precision;
    gradient[at] -= precision * shared_[k];
  }
  for (size_t i = 0; i < unknowns.own().size(); ++i) {
    const int kind = unknowns.own()[i];
    const bool shading = kind >= kViewDeviations;
    // From a sample's centre to its edge a view's exposure is expected to be off by as much as the
    // whole view's is: phones' JPEGs are corrected for vignetting to some per cent.
    const double spread = std::max(
        shading ? expected_[kLogExposure] : spreads_[static_cast<size_t>(kind)], kLeastViewSd);
    const double precision = 1 / (spread * spread);
    for (int v = 0; v < views; ++v) {
      const Eigen::Index at = unknowns.at(v, i);
      hessian(at, at) += precision;
      if (shading) continue;
      gradient[at] -= precision * values_[static_cast<size_t>(v)][static_cast<size_t>(kind)];
      for (int w = 0; w < views; ++w) {
        hessian(unknowns.at(w, i), at) += constants::kMeanDeviationPrecision * precision;
      }
    }
    if (kind != kLogExposure || lamps_.directions.empty()) continue;
    // What the lamps' gradient takes off that precision.
    const Eigen::MatrixXd less =
        precision * Eigen::MatrixXd::Identity(views, views) - ExposurePrecision();
    for (int v = 0; v < views; ++v) {
      for (int w = 0; w < views; ++w) {
        hessian(unknowns.at(v, i), unknowns.at(w, i)) -= less(v, w);
        gradient[unknowns.at(v, i)] += less(v, w) * values_[static_cast<size_t>(w)][kLogExposure];
      }
    }
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(hessian);
  const Eigen::VectorXd step = solver.solve(gradient);
  const Eigen::MatrixXd covariance =
      solver.solve(Eigen::MatrixXd::Identity(hessian.rows(), hessian.cols()));
  std::vector<DeviationValues> variances(values_.size(), DeviationValues{});
  const auto bounded = [](double by) {
    return std::clamp(by, -kMostDeviationStep, kMostDeviationStep);
  };
  for (size_t i = 0; i < unknowns.own().size(); ++i) {
    const auto kind = static_cast<size_t>(unknowns.own()[i]);
    if (kind >= kViewDeviations) continue;
    for (int v = 0; v < views; ++v) {
      const auto k = static_cast<size_t>(v);
      const Eigen::Index at = unknowns.at(v, i);
      values_[k][kind] += bounded(step[at]);
      variances[k][kind] = covariance(at, at);
    }
  }
  for (size_t i = 0; i < unknowns.shared().size(); ++i) {
    const auto k = static_cast<size_t>(unknowns.shared()[i]);
    const double newton = step[unknowns.at_shared(i)];
    shared_[k] += k == kSharedToe || k == kSharedShoulder ? CurveStep(k, newton) : bounded(newton);
  }
  shared_[kSharedShoulder] = std::max(shared_[kSharedShoulder], kLeastShoulder);
  UpdateSpreads(variances);
}

// The inverse of the covariance spread²·1 + gradient²·G·Gᵀ, G the directions (Woodbury).
Eigen::MatrixXd ViewDeviations::ExposurePrecision() const {
  const auto views = static_cast<Eigen::Index>(values_.size());
  const double spread = std::max(spreads_[kLogExposure], kLeastViewSd);
  const double precision = 1 / (spread * spread);
  Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(views, views);
  if (lamps_.directions.empty() || !(lamps_.gradient > 0)) return precision * identity;
  Eigen::MatrixXd by(views, 2);
  for (Eigen::Index v = 0; v < views; ++v) {
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      by(v, axis) = lamps_.directions[static_cast<size_t>(v)][static_cast<size_t>(axis)];
    }
  }
  const Eigen::Matrix2d inner = Eigen::Matrix2d::Identity() / (lamps_.gradient * lamps_.gradient) +
                                precision * by.transpose() * by;
  return precision * identity - precision * precision * by * inner.inverse() * by.transpose();
}

void ViewDeviations::UpdateSpreads(const std::vector<DeviationValues>& variances) {
  // Beside the gradient over lamps.
  Eigen::VectorXd exposures(static_cast<Eigen::Index>(values_.size()));
  for (size_t v = 0; v < values_.size(); ++v) {
    exposures[static_cast<Eigen::Index>(v)] = values_[v][kLogExposure];
  }
  if (!lamps_.directions.empty()) {
    const double spread = std::max(spreads_[kLogExposure], kLeastViewSd);
    exposures = spread * spread * ExposurePrecision() * exposures;
  }
  for (size_t i = 0; i < kViewDeviations; ++i) {
    double squares = constants::kViewSdWeight * expected_[i] * expected_[i];
    for (size_t v = 0; v < values_.size(); ++v) {
      const double value =
          i == kLogExposure ? exposures[static_cast<Eigen::Index>(v)] : values_[v][i];
      squares += value * value + variances[v][i];
    }
    if (expected_[i] > 0) {
      spreads_[i] =
          std::sqrt(squares / (constants::kViewSdWeight + static_cast<double>(values_.size())));
    }
  }
}

}  // namespace glint
