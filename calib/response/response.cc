#include "calib/response/response.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "base/errors/errors.h"
#include "calib/response/local_gamma.h"

namespace glint {
namespace {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;
using response::LocalGamma;

constexpr double kGridLowest = 1.0 / 1020;  // a quarter of a code
constexpr double kHuber = 3;                // in standard deviations
constexpr size_t kLeastObservations = 20;

// Observations that are not clipped, of spots that are seen at two exposures at least, by spot.
std::vector<std::vector<ResponseObservation>> Usable(const ResponseProblem& problem,
                                                     const ResponseOptions& options) {
  std::vector<std::vector<ResponseObservation>> spots(static_cast<size_t>(problem.spots));
  for (const ResponseObservation& o : problem.observations) {
    if (!(o.stored >= options.lowest && o.stored <= options.highest)) continue;
    spots[static_cast<size_t>(o.spot)].push_back(o);
  }
  std::erase_if(spots, [](const auto& spot) { return spot.size() < 2; });
  return spots;
}

// The unknowns: K values of θ, then the corrections of ln t.
class Solver {
 public:
  Solver(const ResponseProblem& problem, const ResponseOptions& options)
      : options_(options),
        exposures_(problem.exposures),
        spots_(Usable(problem, options)),
        curve_(options.knots, kGridLowest),
        corrected_(options.exposure_sigma > 0 ? static_cast<int>(exposures_.size()) : 0),
        unknowns_(VectorXd::Zero(options.knots + corrected_)) {
    RequireEnough();
    unknowns_.head(options.knots).setConstant(std::log(options.usual_gamma));
    curve_.Set(unknowns_.head(options.knots));
  }

  void Solve() {
    double cost = Linearize();
    double damping = 1e-4;
    for (int i = 0; i < options_.max_iterations && damping < 1e8; ++i) {
      const VectorXd before = unknowns_;
      const MatrixXd normal = normal_;
      MatrixXd damped = normal_;
      damped.diagonal() *= 1 + damping;
      const VectorXd step = damped.ldlt().solve(gradient_);
      unknowns_ -= step;
      curve_.Set(unknowns_.head(options_.knots));
      const VectorXd gradient = gradient_;
      const double trial = Linearize();
      if (trial <= cost) {
        const bool settled = cost - trial < 1e-9 * cost && step.norm() < 1e-6;
        cost = trial;
        damping = std::max(1e-9, damping / 5);
        if (settled) break;
        continue;
      }
      unknowns_ = before;
      normal_ = normal;
      gradient_ = gradient;
      curve_.Set(unknowns_.head(options_.knots));
      damping *= 8;
    }
  }

  ResponseEstimate Estimate() {
    Linearize();
    ResponseEstimate estimate;
    estimate.linear = Curve();
    for (size_t j = 0; j < exposures_.size(); ++j) {
      estimate.exposures.push_back(exposures_[j] * std::exp(Correction(static_cast<int>(j))));
    }
    Summarise(&estimate);
    estimate.sigma = Sigma(estimate);
    return estimate;
  }

 private:
  void RequireEnough() const {
    size_t count = 0;
    std::set<int> exposures;
    for (const auto& spot : spots_) {
      count += spot.size();
      for (const ResponseObservation& o : spot) exposures.insert(o.exposure);
    }
    if (count >= kLeastObservations && exposures.size() >= 3) return;
    throw ComputationError(fmt::format(
        "{} unclipped values of spots seen at several exposures, at {} exposures; at least {} at 3 "
        "exposures are needed: take a series of one still scene from dark to bright, one stop "
        "apart",
        count, exposures.size(), kLeastObservations));
  }

  double Correction(int exposure) const {
    return corrected_ > 0 ? unknowns_[options_.knots + exposure] : 0;
  }
  double LogExposure(int exposure) const {
    return std::log(exposures_[static_cast<size_t>(exposure)]) + Correction(exposure);
  }
  // One over the standard deviation of g(v), which the stored value's noise makes. By the usual
  // gamma and not by the curve that is being solved for: a steep curve must not buy small weights.
  double Weight(double stored) const {
    return stored / (options_.usual_gamma * options_.stored_sigma);
  }

  RowVectorXd Row(const ResponseObservation& o) const {
    RowVectorXd row = RowVectorXd::Zero(unknowns_.size());
    row.head(options_.knots) = curve_.Gradient(o.stored);
    if (corrected_ > 0) row[options_.knots + o.exposure] = -1;
    return row;
  }

  void Add(const RowVectorXd& row, double residual, double weight2) {
    normal_.noalias() += weight2 * row.transpose() * row;
    gradient_.noalias() += weight2 * residual * row.transpose();
  }

  // Prior terms: bends, the usual gamma, corrections of exposures.
  double AddPriors() {
    double cost = 0;
    const auto add = [&](const RowVectorXd& row, double residual, double sigma) {
      Add(row, residual, 1 / (sigma * sigma));
      cost += residual * residual / (sigma * sigma);
    };
    for (int k = 0; k < unknowns_.size(); ++k) {
      RowVectorXd row = RowVectorXd::Zero(unknowns_.size());
      row[k] = 1;
      if (k >= options_.knots) {
        add(row, unknowns_[k], options_.exposure_sigma);
        continue;
      }
      add(row, unknowns_[k] - std::log(options_.usual_gamma), options_.gamma_sigma);
      if (k < 1 || k + 1 >= options_.knots) continue;
      row[k] = -2;
      row[k - 1] = row[k + 1] = 1;
      add(row, row.head(options_.knots).dot(unknowns_.head(options_.knots)), options_.bend_sigma);
    }
    return cost;
  }

  // Normal equations at the present unknowns; returns the cost.
  double Linearize() {
    const long n = unknowns_.size();
    normal_ = MatrixXd::Zero(n, n);
    gradient_ = VectorXd::Zero(n);
    double cost = AddPriors();
    for (const auto& spot : spots_) cost += AddSpot(spot);
    return cost;
  }

  // ln E of a spot: a robust weighted mean, by a few rounds of reweighting.
  double LogRadiance(const std::vector<ResponseObservation>& spot) const {
    double mean = 0;
    for (int round = 0; round < 4; ++round) {
      double sum = 0, total = 0;
      for (const ResponseObservation& o : spot) {
        const double value = curve_.G(o.stored) - LogExposure(o.exposure);
        const double weight = Weight(o.stored);
        const double off = round == 0 ? 0 : std::abs(value - mean) * weight;
        const double w2 = weight * weight * (off > kHuber ? kHuber / off : 1);
        sum += w2 * value;
        total += w2;
      }
      mean = sum / total;
    }
    return mean;
  }

  double AddSpot(const std::vector<ResponseObservation>& spot) {
    const double mean = LogRadiance(spot);
    RowVectorXd mean_row = RowVectorXd::Zero(unknowns_.size());
    double total = 0, cost = 0;
    std::vector<RowVectorXd> rows;
    std::vector<double> residuals, weights;
    for (const ResponseObservation& o : spot) {
      const double residual = curve_.G(o.stored) - LogExposure(o.exposure) - mean;
      const double weight = Weight(o.stored), off = std::abs(residual) * weight;
      const double w2 = weight * weight * (off > kHuber ? kHuber / off : 1);
      cost += off > kHuber ? 2 * kHuber * off - kHuber * kHuber : off * off;
      rows.push_back(Row(o));
      residuals.push_back(residual);
      weights.push_back(w2);
      mean_row += w2 * rows.back();
      total += w2;
    }
    mean_row /= total;
    for (size_t i = 0; i < rows.size(); ++i) Add(rows[i] - mean_row, residuals[i], weights[i]);
    return cost;
  }

  std::vector<float> Curve() const {
    std::vector<float> linear(256, 0.0f);
    for (int code = 1; code < 256; ++code) {
      linear[code] = static_cast<float>(std::exp(curve_.G(code / 255.0)));
      // Floats end where a steep dark end goes on; the curve must rise all the same.
      linear[code] = std::max(linear[code], std::nextafter(linear[code - 1], 2.0f));
    }
    linear[255] = 1;
    return linear;
  }

  // Residuals in stored values: those of g by its slope γ/v.
  void Summarise(ResponseEstimate* estimate) const {
    double sum = 0, darkest = INFINITY, brightest = 0;
    estimate->lowest = 1;
    for (const auto& spot : spots_) {
      const double mean = LogRadiance(spot);
      for (const ResponseObservation& o : spot) {
        const double residual = curve_.G(o.stored) - LogExposure(o.exposure) - mean;
        const double off = residual * o.stored / std::exp(curve_.Theta(o.stored));
        sum += off * off;
        ++estimate->observations;
        estimate->lowest = std::min(estimate->lowest, o.stored);
        estimate->highest = std::max(estimate->highest, o.stored);
        darkest = std::min(darkest, exposures_[static_cast<size_t>(o.exposure)]);
        brightest = std::max(brightest, exposures_[static_cast<size_t>(o.exposure)]);
      }
    }
    estimate->spots = static_cast<int>(spots_.size());
    estimate->span = brightest / darkest;
    estimate->rms = std::sqrt(sum / std::max(1, estimate->observations));
  }

  double Sigma(const ResponseEstimate& estimate) const {
    const MatrixXd covariance =
        normal_.ldlt().solve(MatrixXd::Identity(unknowns_.size(), unknowns_.size()));
    const MatrixXd of_theta = covariance.topLeftCorner(options_.knots, options_.knots);
    const RowVectorXd middle = curve_.Gradient(0.5);
    double worst = 0;
    for (int code = 1; code < 255; ++code) {
      const double v = code / 255.0;
      if (v < estimate.lowest || v > estimate.highest) continue;
      const RowVectorXd row = curve_.Gradient(v) - middle;
      worst = std::max(worst, std::sqrt(std::max(0.0, (row * of_theta * row.transpose())(0))));
    }
    return worst;
  }

  ResponseOptions options_;
  std::vector<double> exposures_;
  std::vector<std::vector<ResponseObservation>> spots_;
  LocalGamma curve_;
  int corrected_;
  VectorXd unknowns_;
  MatrixXd normal_;
  VectorXd gradient_;
};

}  // namespace

ResponseEstimate EstimateResponse(const ResponseProblem& problem, const ResponseOptions& options) {
  Solver solver(problem, options);
  const double usual_rms = solver.Estimate().rms;
  solver.Solve();
  ResponseEstimate estimate = solver.Estimate();
  estimate.usual_rms = usual_rms;
  return estimate;
}

}  // namespace glint
