#include "calib/moving_light/lamp_strengths.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "base/parallel/parallel.h"
#include "base/statistics/median.h"
#include "calib/moving_light/gloss_likeness.h"
#include "calib/moving_light/lamp_colours.h"

namespace glint {
namespace {

constexpr double kSlopeSpread = 0.15;  // of facets of canvas, craquelure and brush strokes
constexpr double kMostSlope = 1;
// Scale of e beside a point's own: no surface is matte to better than this.
constexpr double kLeastScale = 0.08;
constexpr double kLeastCosine = 0.02;
constexpr double kLeastRadiance = 2e-4;
constexpr int kMostRounds = 60;
constexpr double kSettled = 0.002;       // of a lamp's logarithm, in one round
constexpr double kOfDisagreement = 0.3;  // a dozen kinds of points that err together

double WeightedMedian(std::vector<std::pair<double, double>>* values) {
  double total = 0;
  for (const auto& [value, weight] : *values) total += weight;
  if (!(total > 0)) return 0;
  std::sort(values->begin(), values->end());
  double sum = 0;
  for (const auto& [value, weight] : *values) {
    sum += weight;
    if (sum >= total / 2) return value;
  }
  return values->back().first;
}

// All by photograph, then point.
class LampSolver {
 public:
  LampSolver(const LampProblem& problem, int threads)
      : problem_(problem),
        lamps_(problem.lights_mm.size()),
        points_(problem.points_mm.size()),
        threads_(threads),
        log_(lamps_ * points_, 0.0),
        known_(lamps_ * points_, false),
        noise_(lamps_ * points_, 0.0),
        strength_(lamps_, 0.0),
        albedo_(points_, 0.0),
        slope_x_(points_, 0.0),
        slope_y_(points_, 0.0),
        scale_(points_, 0.3) {
    for (size_t v = 0; v < lamps_; ++v) {
      for (size_t p = 0; p < points_; ++p) SetObservation(v, p);
    }
  }

  // Solves for the mean of the channels' logarithms.
  void Run() {
    for (size_t p = 0; p < points_; ++p) StartPoint(p);
    for (int round = 0; round < kMostRounds; ++round) {
      ForEachPoint([&](size_t p) { SolvePoint(p); });
      Level();
      const std::vector<double> before = strength_;
      SolveLamps();
      ForEachPoint([&](size_t p) { ScalePoint(p); });
      double moved = 0;
      for (size_t v = 0; v < lamps_; ++v) {
        moved = std::max(moved, std::abs(strength_[v] - before[v]));
      }
      if (moved < kSettled) return;
    }
  }

  // Logarithms about their mean.
  const std::vector<double>& strengths() const { return strength_; }
  // Logarithms, but for a common term.
  const std::vector<double>& albedos() const { return albedo_; }
  // By lamp: how far its points lie about its strength, those of large scale less.
  std::vector<double> Disagreements() const {
    std::vector<double> by_lamp;
    for (size_t v = 0; v < lamps_; ++v) {
      std::vector<double> off;
      for (size_t p = 0; p < points_; ++p) {
        if (!known_[At(v, p)]) continue;
        off.push_back(std::abs(log_[At(v, p)] - strength_[v] - albedo_[p] - ReceivedBy(v, p)));
      }
      by_lamp.push_back(kSdOfMedian * Median(off));
    }
    return by_lamp;
  }
  double used_share(size_t lamp) const {
    size_t used = 0;
    for (size_t p = 0; p < points_; ++p) used += known_[At(lamp, p)];
    return static_cast<double>(used) / static_cast<double>(points_);
  }
  double point_sd() const { return Median(scale_); }

 private:
  size_t At(size_t lamp, size_t point) const { return lamp * points_ + point; }

  void SetObservation(size_t v, size_t p) {
    const std::array<float, 3>& rgb = problem_.radiance[v][p];
    double sum = 0, noise = 0;
    for (const float value : rgb) {
      if (value < 0) return;
      const double radiance = std::max<double>(value, kLeastRadiance);
      sum += std::log(radiance) / 3;
      noise += std::pow(std::log1p(kDarkRadiance / radiance), 2) / 3;
    }
    known_[At(v, p)] = true;
    log_[At(v, p)] = sum;
    noise_[At(v, p)] = noise;
  }

  template <class F>
  void ForEachPoint(const F& work) const {
    constexpr int kBlock = 256;
    ForEachBlock(static_cast<int>(points_), kBlock, threads_, [&](int begin, int end) {
      for (int p = begin; p < end; ++p) work(static_cast<size_t>(p));
    });
  }

  // Logarithm of what a matte surface of this slope receives, and its derivatives by the slopes.
  struct Received {
    double value, by_x, by_y;
  };
  Received ReceivedAt(size_t v, size_t p, double slope_x, double slope_y) const {
    const Eigen::Vector3d to = problem_.lights_mm[v] - problem_.points_mm[p];
    const double distance = to.norm(), square = 1 + slope_x * slope_x + slope_y * slope_y;
    const Eigen::Vector3d l = to / distance;
    const double along = slope_x * l.x() + slope_y * l.y() + l.z();
    const double cosine = along / std::sqrt(square);
    const double value = std::log(std::max(cosine, kLeastCosine)) - 2 * std::log(distance);
    if (cosine <= kLeastCosine) return {value, 0, 0};
    return {value, l.x() / along - slope_x / square, l.y() / along - slope_y / square};
  }
  double ReceivedBy(size_t v, size_t p) const {
    return ReceivedAt(v, p, slope_x_[p], slope_y_[p]).value;
  }

  void StartPoint(size_t p) {
    std::vector<double> values;
    for (size_t v = 0; v < lamps_; ++v) {
      if (known_[At(v, p)]) values.push_back(log_[At(v, p)] - ReceivedBy(v, p));
    }
    albedo_[p] = Median(values);
  }

  double Scale(size_t v, size_t p) const {
    return std::sqrt(scale_[p] * scale_[p] + kLeastScale * kLeastScale + noise_[At(v, p)]);
  }

  // A Gauss-Newton step with Cauchy's weights.
  void SolvePoint(size_t p) {
    Eigen::Matrix3d a = Eigen::Matrix3d::Identity() * 1e-9;
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (size_t v = 0; v < lamps_; ++v) {
      if (!known_[At(v, p)]) continue;
      const Received received = ReceivedAt(v, p, slope_x_[p], slope_y_[p]);
      const double e = log_[At(v, p)] - strength_[v] - albedo_[p] - received.value;
      const double scale = Scale(v, p), w = 1 / (scale * scale + e * e);
      const Eigen::Vector3d row(1, received.by_x, received.by_y);
      a += w * row * row.transpose();
      b += w * e * row;
    }
    const double precision = 1 / (kSlopeSpread * kSlopeSpread);
    a(1, 1) += precision;
    a(2, 2) += precision;
    b[1] -= precision * slope_x_[p];
    b[2] -= precision * slope_y_[p];
    const Eigen::Vector3d step = a.ldlt().solve(b);
    const auto moved = [](double slope, double by) {
      constexpr double kMostStep = 0.2;
      return std::clamp(slope + std::clamp(by, -kMostStep, kMostStep), -kMostSlope, kMostSlope);
    };
    albedo_[p] += step[0];
    slope_x_[p] = moved(slope_x_[p], step[1]);
    slope_y_[p] = moved(slope_y_[p], step[2]);
  }

  void Level() {
    double sum_x = 0, sum_y = 0, weights = 0;
    for (size_t p = 0; p < points_; ++p) {
      const double w = 1 / (scale_[p] * scale_[p] + kLeastScale * kLeastScale);
      sum_x += w * slope_x_[p];
      sum_y += w * slope_y_[p];
      weights += w;
    }
    for (double& slope : slope_x_) slope -= sum_x / weights;
    for (double& slope : slope_y_) slope -= sum_y / weights;
  }

  void SolveLamps() {
    ForEachPiece(static_cast<int>(lamps_), threads_, [&](int lamp) {
      const auto v = static_cast<size_t>(lamp);
      std::vector<std::pair<double, double>> values;
      for (size_t p = 0; p < points_; ++p) {
        if (!known_[At(v, p)]) continue;
        const double scale = Scale(v, p);
        values.emplace_back(log_[At(v, p)] - albedo_[p] - ReceivedBy(v, p), 1 / (scale * scale));
      }
      strength_[v] = WeightedMedian(&values);
    });
    const double mean =
        std::accumulate(strength_.begin(), strength_.end(), 0.0) / static_cast<double>(lamps_);
    for (double& strength : strength_) strength -= mean;
  }

  void ScalePoint(size_t p) {
    std::vector<double> off;
    for (size_t v = 0; v < lamps_; ++v) {
      if (!known_[At(v, p)]) continue;
      off.push_back(std::abs(log_[At(v, p)] - strength_[v] - albedo_[p] - ReceivedBy(v, p)));
    }
    scale_[p] = kSdOfMedian * Median(off);
  }

  const LampProblem& problem_;
  size_t lamps_, points_;
  int threads_;
  std::vector<double> log_;
  std::vector<char> known_;
  std::vector<double> noise_;              // variance of log_ from rounding
  std::vector<double> strength_, albedo_;  // logarithms
  std::vector<double> slope_x_, slope_y_;  // n_x / n_z, n_y / n_z
  std::vector<double> scale_;
};

// What single lamps differ by, of the strengths that a matte surface tells: these are a Gaussian
// process over the directions, what gloss and the sample's tilt feign; the lamps' own; and an error
// as large as the points disagree. The mean of the second, given their sum (Rasmussen and Williams
// 2006, 2.25), with Cauchy's weights: one lamp may differ from all others.
std::vector<double> OwnPart(const std::vector<Eigen::Vector3d>& lights_mm,
                            const std::vector<double>& strengths,
                            const std::vector<double>& disagreement) {
  constexpr double kFeigned = 0.5;  // gloss doubles what a sample reflects, and more
  constexpr double kOwn = 0.15;     // lamps of a dome, and hands that hold one
  constexpr int kRounds = 5;
  const auto n = static_cast<Eigen::Index>(strengths.size());
  Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(strengths.data(), n);
  y.array() -= y.mean();
  const Eigen::MatrixXd feigned = kFeigned * kFeigned * GlossLikeness(lights_mm);
  Eigen::VectorXd own = Eigen::VectorXd::Zero(n), variance = own;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixXd sum = feigned;
    for (Eigen::Index i = 0; i < n; ++i) {
      variance[i] = kOwn * kOwn + own[i] * own[i];
      const double error = kOfDisagreement * disagreement[static_cast<size_t>(i)];
      sum(i, i) += variance[i] + error * error;
    }
    own = variance.asDiagonal() * sum.ldlt().solve(y);
  }
  own.array() -= own.mean();
  return {own.data(), own.data() + n};
}

// About 0, red's or blue's.
double SpreadOf(const std::vector<LampColour>& colours) {
  double red = 0, blue = 0;
  for (const LampColour& colour : colours) {
    red += colour.red * colour.red;
    blue += colour.blue * colour.blue;
  }
  return std::sqrt(std::max(red, blue) / static_cast<double>(colours.size()));
}

void CheckProblem(const LampProblem& problem) {
  if (problem.radiance.size() != problem.lights_mm.size()) {
    throw std::invalid_argument("a light for every photograph is expected");
  }
  for (const auto& photo : problem.radiance) {
    if (photo.size() == problem.points_mm.size()) continue;
    throw std::invalid_argument("radiance at every point is expected");
  }
}

}  // namespace

LampStrengths EstimateLampStrengths(const LampProblem& problem, int threads) {
  CheckProblem(problem);
  constexpr size_t kFewest = 3;
  LampStrengths result;
  result.lamps.resize(problem.lights_mm.size());
  if (problem.lights_mm.size() < kFewest || problem.points_mm.empty()) return result;
  LampSolver solver(problem, threads);
  solver.Run();
  result.point_sd = solver.point_sd();
  const std::vector<double> own =
      OwnPart(problem.lights_mm, solver.strengths(), solver.Disagreements());
  const std::vector<LampColour> colours = EstimateLampColours(problem, solver.albedos(), threads);
  for (size_t v = 0; v < result.lamps.size(); ++v) {
    LampStrength& lamp = result.lamps[v];
    lamp.exposure = std::exp(own[v]);
    const auto& [red, blue] = colours[v];
    const double mean = (red + blue) / 3;
    lamp.colour = {std::exp(red - mean), std::exp(-mean), std::exp(blue - mean)};
    lamp.used_share = solver.used_share(v);
  }
  result.colour_sd = SpreadOf(colours);
  return result;
}

}  // namespace glint
