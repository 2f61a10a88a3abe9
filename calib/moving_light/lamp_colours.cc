#include "calib/moving_light/lamp_colours.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/parallel/parallel.h"
#include "base/statistics/median.h"
#include "calib/moving_light/gloss_likeness.h"

namespace glint {
namespace {

class ColourSolver {
 public:
  ColourSolver(const LampProblem& problem, const std::vector<double>& log_albedo, int threads)
      : lamps_(problem.lights_mm.size()),
        points_(problem.points_mm.size()),
        threads_(threads),
        ratio_(lamps_ * points_, Pair::Constant(std::nan(""))),
        lamp_(lamps_, Eigen::Vector3d(0, 0, kUsualGloss)),
        point_(points_, Pair::Zero()),
        diffuse_(points_, Pair::Ones()),
        scale_(points_, Pair::Zero()),
        dark_(points_, 0.0) {
    // A level of the sample's, and what changes with the light.
    gloss_ = kGloss * kGloss * (GlossLikeness(problem.lights_mm).array() + 1).matrix();
    TakeRatios(problem);
    TakeAlbedos(log_albedo);
  }

  void Run() {
    constexpr int kRounds = 20;
    for (size_t p = 0; p < points_; ++p) StartPoint(p);
    for (int round = 0; round < kRounds; ++round) {
      SolveLamps();
      ForEachPiece(static_cast<int>(points_), threads_,
                   [&](int p) { SolvePoint(static_cast<size_t>(p)); });
    }
  }

  std::vector<LampColour> Colours() const {
    std::vector<LampColour> colours;
    for (const Eigen::Vector3d& lamp : lamp_) colours.push_back({lamp[0], lamp[1]});
    return colours;
  }

 private:
  using Pair = Eigen::Array2d;

  void TakeRatios(const LampProblem& problem) {
    for (size_t v = 0; v < lamps_; ++v) {
      for (size_t p = 0; p < points_; ++p) {
        const auto& rgb = problem.radiance[v][p];
        if (std::min({rgb[0], rgb[1], rgb[2]}) < 2 * kDarkRadiance) continue;
        ratio_[v * points_ + p] = {std::log(rgb[0] / rgb[1]), std::log(rgb[2] / rgb[1])};
      }
    }
  }
  void TakeAlbedos(const std::vector<double>& log_albedo) {
    std::vector<double> known;
    std::copy_if(log_albedo.begin(), log_albedo.end(), std::back_inserter(known),
                 [](double albedo) { return std::isfinite(albedo); });
    const double middle = Median(known);
    for (size_t p = 0; p < points_; ++p) {
      if (std::isfinite(log_albedo[p])) dark_[p] = std::exp(middle - log_albedo[p]);
    }
  }

  bool Known(size_t v, size_t p) const { return !std::isnan(ratio_[v * points_ + p][0]); }
  // Residuals, and their derivatives by −ρ and −t.
  struct Look {
    Pair off, by_point, by_gloss;
  };
  Look At(size_t v, size_t p) const {
    const double g = std::exp(lamp_[v][2]) * dark_[p];
    const Pair& diffuse = diffuse_[p];
    Look look;
    look.off =
        ratio_[v * points_ + p] - lamp_[v].head<2>().array() - ((diffuse + g) / (1 + g)).log();
    look.by_point = diffuse / (diffuse + g);
    look.by_gloss = g * (1 - diffuse) / ((diffuse + g) * (1 + g));
    return look;
  }

  void StartPoint(size_t p) {
    std::vector<double> values[2];
    for (size_t v = 0; v < lamps_; ++v) {
      if (!Known(v, p)) continue;
      for (Eigen::Index c = 0; c < 2; ++c) values[c].push_back(ratio_[v * points_ + p][c]);
    }
    if (values[0].size() < 3 || !(dark_[p] > 0)) return;
    for (Eigen::Index c = 0; c < 2; ++c) point_[p][c] = Median(values[c]);
    diffuse_[p] = point_[p].exp();
    scale_[p] = Pair::Constant(0.1);
  }

  // A step of Gauss and Newton with Cauchy's weights, and the scale of what is left.
  void SolvePoint(size_t p) {
    if (scale_[p][0] <= 0) return;
    Pair products = Pair::Constant(1e-9), right = Pair::Zero();
    std::vector<double> off[2];
    for (size_t v = 0; v < lamps_; ++v) {
      if (!Known(v, p)) continue;
      const Look look = At(v, p);
      const Pair weight = 1 / (scale_[p].square() + look.off.square());
      products += weight * look.by_point.square();
      right += weight * look.by_point * look.off;
      for (Eigen::Index c = 0; c < 2; ++c) off[c].push_back(std::abs(look.off[c]));
    }
    constexpr double kMostStep = 0.3;
    point_[p] += (right / products).min(kMostStep).max(-kMostStep);
    diffuse_[p] = point_[p].exp();
    for (Eigen::Index c = 0; c < 2; ++c) {
      scale_[p][c] = std::hypot(kSdOfMedian * Median(off[c]), kLeastScale);
    }
  }

  // The normal equations of a lamp's a and t; points together count as kKinds of them.
  struct Lamp {
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();

    Eigen::Matrix2d Colour() const { return products.topLeftCorner<2, 2>(); }
    Eigen::Vector2d Mixed() const { return products.topRightCorner<2, 1>(); }
  };
  Lamp EquationsOf(size_t v) const {
    Lamp lamp;
    double count = 0;
    for (size_t p = 0; p < points_; ++p) {
      if (!Known(v, p) || scale_[p][0] <= 0) continue;
      const Look look = At(v, p);
      const Pair weight = 1 / (scale_[p].square() + look.off.square());
      for (Eigen::Index c = 0; c < 2; ++c) {
        Eigen::Vector3d row(0, 0, look.by_gloss[c]);
        row[c] = 1;
        lamp.products += weight[c] * row * row.transpose();
        lamp.right += weight[c] * look.off[c] * row;
      }
      count += 1;
    }
    const double worth = std::min(1.0, kKinds / std::max(count, 1.0));
    lamp.products *= worth;
    lamp.right *= worth;
    for (Eigen::Index c = 0; c < 2; ++c) {
      lamp.products(c, c) += 1 / (kColour * kColour);
      lamp.right[c] -= lamp_[v][c] / (kColour * kColour);
    }
    return lamp;
  }

  // The mean of a Gaussian process of covariance K = gloss_ that is told `right` with the
  // precisions T: (K⁻¹ + T)⁻¹ q = Kq − K√T (1 + √T K √T)⁻¹ √T K q.
  Eigen::VectorXd Smoothed(const Eigen::VectorXd& precisions, const Eigen::VectorXd& right) const {
    const Eigen::VectorXd root = precisions.cwiseSqrt(), told = gloss_ * right;
    Eigen::MatrixXd inner = root.asDiagonal() * gloss_ * root.asDiagonal();
    inner.diagonal().array() += 1;
    return told - gloss_ * root.cwiseProduct(inner.ldlt().solve(root.cwiseProduct(told)));
  }

  // A step of Gauss and Newton: a is eliminated, then solved with the t that is found.
  void SolveLamps() {
    std::vector<Lamp> lamps(lamps_);
    ForEachPiece(static_cast<int>(lamps_), threads_, [&](int v) {
      lamps[static_cast<size_t>(v)] = EquationsOf(static_cast<size_t>(v));
    });
    const auto n = static_cast<Eigen::Index>(lamps_);
    Eigen::VectorXd precisions(n), right(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto v = static_cast<size_t>(i);
      const Eigen::Vector2d solved = lamps[v].Colour().inverse() * lamps[v].Mixed();
      precisions[i] = std::max(0.0, lamps[v].products(2, 2) - lamps[v].Mixed().dot(solved));
      right[i] = lamps[v].right[2] - solved.dot(lamps[v].right.head<2>()) +
                 precisions[i] * (lamp_[v][2] - kUsualGloss);
    }
    const Eigen::VectorXd gloss = Smoothed(precisions, right);
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (size_t v = 0; v < lamps_; ++v) {
      constexpr double kMostStep = 1;
      const double wanted = kUsualGloss + gloss[static_cast<Eigen::Index>(v)] - lamp_[v][2];
      const double step = std::clamp(wanted, -kMostStep, kMostStep);
      lamp_[v].head<2>() +=
          lamps[v].Colour().inverse() * (lamps[v].right.head<2>() - step * lamps[v].Mixed());
      lamp_[v][2] += step;
      mean += lamp_[v].head<2>() / static_cast<double>(lamps_);
    }
    for (auto& lamp : lamp_) lamp.head<2>() -= mean;
  }

  static constexpr double kLeastScale = 0.01;
  static constexpr double kColour = 0.1;  // of lamps about their mean
  // Of t: gloss is from .01 to .2 of the diffuse, and changes as much between lamps.
  static constexpr double kUsualGloss = -3, kGloss = 1.5;
  static constexpr double kKinds = 12;  // of points that err together

  size_t lamps_, points_;
  int threads_;
  std::vector<Pair> ratio_;            // by lamp, then point; NaN: not known
  std::vector<Eigen::Vector3d> lamp_;  // a of red and blue, t
  std::vector<Pair> point_, diffuse_;  // ρ, e^ρ
  std::vector<Pair> scale_;            // of e; 0: the point is not known
  std::vector<double> dark_;           // 1/b; 0: not known
  Eigen::MatrixXd gloss_;              // covariance of t
};

}  // namespace

std::vector<LampColour> EstimateLampColours(const LampProblem& problem,
                                            const std::vector<double>& log_albedo, int threads) {
  ColourSolver solver(problem, log_albedo, threads);
  solver.Run();
  return solver.Colours();
}

}  // namespace glint
