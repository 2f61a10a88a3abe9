#include "calib/chart/solve_chart.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/errors/errors.h"
#include "calib/chart/cielab.h"
#include "calib/chart/delta_e.h"

namespace glint {
namespace {

constexpr int kFolds = 4;

// A chart is printed and a patch read to about 1 ΔE. Beyond three times that a patch is dirty or
// shows a highlight.
constexpr double kHuber = 3;

// Standard deviations of the light's three numbers. A phone's main camera sees 78° across its
// diagonal; a chart that fills its picture has a half diagonal of tan 39° of the flash's distance,
// g = 0.66. A flash 30° off the middle has a or b = 2·√g·sin 30° = 0.81. Both are wide: twenty
// patches tell each to a few hundredths.
constexpr double kSpreadOfG = 0.66, kSpreadOfAB = 0.81;

// The least of ChartLight's q: a tenth of the distance from the middle to the
// flash, which then touches the chart. Fits end above it; patches that they did not see may lie
// where they make no sense.
constexpr double kLeastQ = 0.01;

struct Observation {
  size_t patch;
  Eigen::Vector2d at;
  Eigen::Vector3d rgb, lab;
};

// Without the scale: reflectance = matrix · terms(rgb) / light.
struct Fit {
  ColourCorrection reflectance;
  ChartLight light;
  Eigen::Vector3d LabOf(const Observation& seen) const {
    return LabFromRec709(Eigen::Vector3d(reflectance(seen.rgb) / light.At(seen.at)));
  }
};

// Residuals of one patch, in ΔE.
template <int kTerms>
class PatchCost {
 public:
  PatchCost(const Observation& seen, ColourModel model)
      : terms_(ColourCorrection::TermsOf(model, seen.rgb)),
        at_(seen.at),
        lab_(seen.lab),
        metric_(DeltaE00Metric(seen.lab)) {}

  template <class T>
  bool operator()(const T* matrix, const T* light, T* residuals) const {
    const T q = T(1) + light[0] * at_.x() + light[1] * at_.y() + light[2] * at_.squaredNorm();
    if (!(q > T(kLeastQ))) return false;  // no light is there: the step was too long
    using std::sqrt;
    const T darker = q * sqrt(q);  // 1 / light
    Eigen::Matrix<T, 3, 1> rgb;
    for (int row = 0; row < 3; ++row) {
      rgb[row] = T(0);
      for (int term = 0; term < kTerms; ++term) {
        rgb[row] += matrix[kTerms * row + term] * terms_[term];
      }
      rgb[row] *= darker;
    }
    const Eigen::Matrix<T, 3, 1> off = LabFromRec709(rgb) - lab_.cast<T>();
    Eigen::Map<Eigen::Matrix<T, 3, 1>> weighted(residuals);
    weighted = metric_.cast<T>() * off;
    return true;
  }

 private:
  ColourCorrection::Terms terms_;
  Eigen::Vector2d at_;
  Eigen::Vector3d lab_;
  Eigen::Matrix3d metric_;
};

// Linear least squares without fall-off; relative errors count alike, down to 5 % reflectance.
ColourCorrection InitialCorrection(const std::vector<Observation>& seen, ColourModel model) {
  const int terms = ColourTerms(model);
  Eigen::MatrixXd left(seen.size(), terms), right(seen.size(), 3);
  for (size_t i = 0; i < seen.size(); ++i) {
    const Eigen::Vector3d reference = Rec709FromLab(seen[i].lab);
    const double weight = 1 / (0.05 + std::max(0.0, reference.y()));
    left.row(i) = weight * ColourCorrection::TermsOf(model, seen[i].rgb).head(terms).transpose();
    right.row(i) = weight * reference.transpose();
  }
  ColourCorrection initial{model, ColourCorrection::Matrix::Zero()};
  initial.matrix.leftCols(terms) = left.colPivHouseholderQr().solve(right).transpose();
  return initial;
}

template <int kTerms>
Fit FitPatches(const std::vector<Observation>& seen, ColourModel model) {
  Fit fit{InitialCorrection(seen, model), {}};
  std::array<double, 3 * kTerms> matrix;
  for (int i = 0; i < 3 * kTerms; ++i) matrix[i] = fit.reflectance.matrix(i / kTerms, i % kTerms);
  std::array<double, 3> light{0, 0, 0};
  ceres::Problem problem;
  for (const Observation& one : seen) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PatchCost<kTerms>, 3, 3 * kTerms, 3>(
                                 new PatchCost<kTerms>(one, model)),
                             new ceres::HuberLoss(kHuber), matrix.data(), light.data());
  }
  const Eigen::Vector3d spread(kSpreadOfAB, kSpreadOfAB, kSpreadOfG);
  problem.AddResidualBlock(
      new ceres::NormalPrior(Eigen::Matrix3d(spread.cwiseInverse().asDiagonal()),
                             Eigen::Vector3d::Zero()),
      nullptr, light.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    throw ComputationError("the chart's colours could not be fitted: " + summary.message);
  }
  for (int i = 0; i < 3 * kTerms; ++i) fit.reflectance.matrix(i / kTerms, i % kTerms) = matrix[i];
  fit.light = {light[0], light[1], light[2]};
  return fit;
}

Fit FitModel(const std::vector<Observation>& seen, ColourModel model) {
  return model == ColourModel::kLinear ? FitPatches<3>(seen, model) : FitPatches<6>(seen, model);
}

std::vector<Observation> UsableOf(const Chart& chart, const std::vector<PatchReading>& readings) {
  std::vector<Observation> seen;
  for (size_t i = 0; i < readings.size(); ++i) {
    if (!readings[i].usable()) continue;
    const ChartPatch& patch = chart.patches[i];
    seen.push_back({i, chart.FromMiddle(patch.centre), readings[i].rgb, patch.lab});
  }
  return seen;
}

// What is corrected to (1, 1, 1), by Newton's method from the linear part's answer: both models are
// smooth where all channels are above 0.
Eigen::Vector3d WhiteOf(const ColourCorrection& reflectance) {
  const Eigen::Vector3d white = Eigen::Vector3d::Ones();
  Eigen::Vector3d rgb = Eigen::Vector3d::Constant(1 / std::max(1e-6, reflectance(white).mean()));
  for (int round = 0; round < 50; ++round) {
    Eigen::Matrix3d slope;
    for (int c = 0; c < 3; ++c) {
      Eigen::Vector3d near = rgb;
      near[c] *= 1 + 1e-6;
      slope.col(c) = (reflectance(near) - reflectance(rgb)) / (1e-6 * rgb[c]);
    }
    const Eigen::Vector3d step = slope.fullPivLu().solve(white - reflectance(rgb));
    // No channel falls to less than a half at once.
    rgb = (rgb + step).cwiseMax(rgb / 2);
    if (step.cwiseAbs().maxCoeff() < 1e-12 * rgb.maxCoeff()) break;
  }
  if (!rgb.allFinite() || (reflectance(rgb) - white).norm() > 1e-6) {
    throw ComputationError(
        "the chart's colours could not be fitted: no stored colour maps to white");
  }
  return rgb;
}

// The light's exposure that suits the camera's own colours best, in the mean over patches of ΔE.
std::vector<double> Uncorrected(const std::vector<Observation>& seen, const ChartLight& light) {
  const auto errors = [&](double scale) {
    std::vector<double> all;
    all.reserve(seen.size());
    for (const Observation& one : seen) {
      all.push_back(
          DeltaE00(LabFromRec709(Eigen::Vector3d(scale * one.rgb / light.At(one.at))), one.lab));
    }
    return all;
  };
  const auto sum = [&](double scale) {
    const auto all = errors(scale);
    return std::accumulate(all.begin(), all.end(), 0.0);
  };
  double scale = 0, total = 0;
  for (const Observation& one : seen) {
    scale += Rec709FromLab(one.lab).y();
    total += one.rgb.y() / light.At(one.at);
  }
  scale /= std::max(total, 1e-9);
  // From steps of 20 % down to 0.1 %, each the square root of the one before.
  constexpr int kRounds = 9;
  double step = 1.2;
  for (int round = 0; round < kRounds; ++round, step = std::sqrt(step)) {
    while (sum(scale * step) < sum(scale)) scale *= step;
    while (sum(scale / step) < sum(scale)) scale /= step;
  }
  return errors(scale);
}

void HoldOut(const std::vector<Observation>& seen, ColourModel model,
             std::vector<PatchColour>* patches) {
  for (int fold = 0; fold < kFolds; ++fold) {
    std::vector<Observation> others;
    for (size_t i = 0; i < seen.size(); ++i) {
      if (static_cast<int>(i % kFolds) != fold) others.push_back(seen[i]);
    }
    const Fit fit = FitModel(others, model);
    for (size_t i = static_cast<size_t>(fold); i < seen.size(); i += kFolds) {
      PatchColour& patch = (*patches)[i];
      patch.held_out_lab = fit.LabOf(seen[i]);
      patch.held_out = DeltaE00(patch.held_out_lab, seen[i].lab);
    }
  }
}

double MeanOf(const std::vector<PatchColour>& patches, double PatchColour::*field) {
  double sum = 0;
  for (const PatchColour& patch : patches) sum += patch.*field;
  return sum / static_cast<double>(std::max<size_t>(1, patches.size()));
}

double WorstOf(const std::vector<PatchColour>& patches, double PatchColour::*field) {
  double worst = 0;
  for (const PatchColour& patch : patches) worst = std::max(worst, patch.*field);
  return worst;
}

}  // namespace

double ChartLight::At(const Eigen::Vector2d& point) const {
  const double q = 1 + a * point.x() + b * point.y() + g * point.squaredNorm();
  return std::pow(std::max(q, kLeastQ), -1.5);
}

double ChartSolution::MeanDeltaE() const { return MeanOf(patches, &PatchColour::delta_e); }
double ChartSolution::WorstDeltaE() const { return WorstOf(patches, &PatchColour::delta_e); }
double ChartSolution::HeldOutMean() const { return MeanOf(patches, &PatchColour::held_out); }
double ChartSolution::HeldOutWorst() const { return WorstOf(patches, &PatchColour::held_out); }
double ChartSolution::UncorrectedMean() const { return MeanOf(patches, &PatchColour::uncorrected); }

// Unknowns are 3 · terms and the light's 3, a patch tells 3: with three quarters of these patches
// there are half as many numbers again as unknowns.
int FewestPatches(ColourModel model) { return 2 * (ColourTerms(model) + 1); }

ChartSolution SolveChart(const Chart& chart, const std::vector<PatchReading>& readings,
                         ColourModel model) {
  const std::vector<Observation> seen = UsableOf(chart, readings);
  const Fit fit = FitModel(seen, model);
  ChartSolution solution;
  solution.light = fit.light;
  solution.white_rgb = WhiteOf(fit.reflectance);
  solution.correction = fit.reflectance;
  solution.correction.matrix *= solution.white_rgb.y();
  const std::vector<double> uncorrected = Uncorrected(seen, fit.light);
  for (size_t i = 0; i < seen.size(); ++i) {
    PatchColour& patch = solution.patches.emplace_back();
    patch.patch = seen[i].patch;
    patch.lab = fit.LabOf(seen[i]);
    patch.delta_e = DeltaE00(patch.lab, seen[i].lab);
    patch.uncorrected = uncorrected[i];
  }
  HoldOut(seen, model, &solution.patches);
  return solution;
}

ChartSolution SolveGreyCard(const Chart& chart, const PatchReading& reading) {
  const ChartPatch& card = chart.patches.at(0);
  ChartSolution solution;
  solution.correction.matrix.setZero();
  for (int c = 0; c < 3; ++c) solution.correction.matrix(c, c) = reading.rgb.y() / reading.rgb[c];
  solution.white_rgb = reading.rgb / Rec709FromLab(card.lab).y();
  PatchColour& patch = solution.patches.emplace_back();
  patch.patch = 0;
  patch.lab = patch.held_out_lab = card.lab;
  patch.uncorrected = Uncorrected({{0, {0, 0}, reading.rgb, card.lab}}, {})[0];
  return solution;
}

}  // namespace glint
