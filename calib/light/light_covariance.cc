#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "calib/light/light_cost.h"

namespace glint::light {
namespace {

// Smooth errors that residuals hardly show (ink's blur, JPEG, the tone curve): this share of the
// radiance, in every photograph of its own and in all of them alike, per mode.
constexpr double kSmoothError = 0.001;
constexpr int kModes = 5;

// Blocks in the layout's order: columns of the evaluated Jacobian.
std::vector<double*> BlocksOf(const Layout& layout, State* state) {
  std::vector<double*> blocks;
  if (layout.flash >= 0) blocks.push_back(state->flash_mm.data());
  blocks.push_back(state->log_q.data());
  if (layout.ambient >= 0) blocks.push_back(state->ambient.data());
  if (layout.gloss >= 0) blocks.push_back(&state->gloss);
  blocks.push_back(&state->smear);
  if (layout.tone >= 0) blocks.push_back(state->tone.data());
  for (size_t c = 0; c < layout.vignetting.size(); ++c) {
    if (layout.vignetting[c] >= 0) blocks.push_back(state->vignetting[c].data());
  }
  for (size_t i = 0; i < layout.exposure.size(); ++i) {
    if (layout.exposure[i] >= 0) blocks.push_back(state->photos[i].log_exposure.data());
  }
  return blocks;
}

// Sums over all rows; gradients of one block's.
struct Sums {
  Eigen::MatrixXd normal;     // JᵀJ
  Eigen::MatrixXd gradients;  // Σ gₛgₛᵀ
  int clusters = 0;
};

Sums Accumulate(const ceres::CRSMatrix& jacobian, const std::vector<double>& residuals,
                const std::vector<int>& cluster_of_row, int columns) {
  Sums sums{Eigen::MatrixXd::Zero(columns, columns), Eigen::MatrixXd::Zero(columns, columns), 0};
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(columns);
  const size_t spot_rows = cluster_of_row.size();
  for (int row = 0; row < jacobian.num_rows; ++row) {
    for (int a = jacobian.rows[row]; a < jacobian.rows[row + 1]; ++a) {
      for (int b = jacobian.rows[row]; b < jacobian.rows[row + 1]; ++b) {
        sums.normal(jacobian.cols[a], jacobian.cols[b]) += jacobian.values[a] * jacobian.values[b];
        if (static_cast<size_t>(row) >= spot_rows) {  // a prior tells what its σ says
          sums.gradients(jacobian.cols[a], jacobian.cols[b]) +=
              jacobian.values[a] * jacobian.values[b];
        }
      }
      if (static_cast<size_t>(row) < spot_rows) {
        gradient[jacobian.cols[a]] += jacobian.values[a] * residuals[row];
      }
    }
    if (static_cast<size_t>(row) >= spot_rows) continue;
    const bool last =
        static_cast<size_t>(row) + 1 == spot_rows || cluster_of_row[row + 1] != cluster_of_row[row];
    if (!last) continue;
    sums.gradients += gradient * gradient.transpose();
    gradient.setZero();
    ++sums.clusters;
  }
  return sums;
}

// Smooth relative errors of 1 at a spot, in the picture and over the tones.
std::array<double, kModes> ModesAt(const Camera& camera, const Spot& spot) {
  const double x = 2 * spot.point_px.x() / camera.width_px - 1;
  const double y = 2 * spot.point_px.y() / camera.height_px - 1;
  return {1, x, y, 2 * spot.geometry.r2 - 0.5, std::log(std::max(0.01, spot.seen.y())) + 1};
}

// Σ over photographs and over all of them together of what smooth errors do to the gradient.
Eigen::MatrixXd SystematicGradients(const LightProblem& problem, const State& state,
                                    const ceres::CRSMatrix& jacobian, int columns) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(columns, columns);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(columns, kModes);
  int row = 0;
  for (const PhotoState& photo : state.photos) {
    if (!photo.used) continue;
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(columns, kModes);
    for (const Spot& spot : photo.spots) {
      if (!spot.inlier) continue;
      const auto modes = ModesAt(problem.cameras[photo.camera], spot);
      for (int c = 0; c < 3; ++c, ++row) {
        const double weight = spot.seen[c] / (spot.sigma[c] * state.weighing_scale());
        for (int a = jacobian.rows[row]; a < jacobian.rows[row + 1]; ++a) {
          for (int m = 0; m < kModes; ++m) {
            own(jacobian.cols[a], m) += weight * modes[m] * jacobian.values[a];
          }
        }
      }
    }
    sum += own * own.transpose();
    all += own;
  }
  return kSmoothError * kSmoothError * (sum + all * all.transpose());
}

}  // namespace

Layout LayoutOf(const State& state) {
  Layout layout;
  const auto take = [&layout](bool held, int count) {
    if (held) return -1;
    layout.columns += count;
    return layout.columns - count;
  };
  layout.flash = take(state.hold_flash, 3);
  layout.log_q = take(false, 3);
  layout.ambient = take(state.hold_ambient, 3);
  layout.gloss = take(state.hold_gloss, 1);
  layout.smear = take(false, 1);
  layout.tone = take(state.hold_tone, 3);
  std::vector<bool> seen(state.vignetting.size(), false);
  for (const PhotoState& photo : state.photos) {
    if (photo.used) seen[photo.camera] = true;
  }
  for (size_t c = 0; c < state.vignetting.size(); ++c) {
    layout.vignetting.push_back(take(!seen[c] || state.hold_vignetting[c], 3));
  }
  for (size_t i = 0; i < state.photos.size(); ++i) {
    layout.exposure.push_back(take(!state.photos[i].used || static_cast<int>(i) == state.first, 3));
  }
  return layout;
}

Eigen::MatrixXd Covariance(const LightProblem& problem_given, const LightOptions& options,
                           const State& fixed, const Layout& layout) {
  State state = fixed;
  ceres::Problem problem;
  AddSpots(false, &state, &problem);
  AddPriors(options, &state, &problem);
  HoldBlocks(&state, &problem);
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.parameter_blocks = BlocksOf(layout, &state);
  std::vector<double> residuals;
  ceres::CRSMatrix jacobian;
  problem.Evaluate(evaluate, nullptr, &residuals, nullptr, &jacobian);
  std::vector<int> clusters;
  for (size_t i = 0; i < state.photos.size(); ++i) {
    if (!state.photos[i].used) continue;
    for (const Spot& spot : state.photos[i].spots) {
      if (spot.inlier) clusters.insert(clusters.end(), 3, spot.cluster);
    }
  }
  const int n = layout.columns;
  const Sums sums = Accumulate(jacobian, residuals, clusters, n);
  const Eigen::VectorXd scale = sums.normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * sums.normal * scale.asDiagonal();
  const Eigen::MatrixXd inverse = scale.asDiagonal() *
                                  scaled.ldlt().solve(Eigen::MatrixXd::Identity(n, n)) *
                                  scale.asDiagonal();
  const double finite = sums.clusters > n ? static_cast<double>(sums.clusters) /
                                                static_cast<double>(sums.clusters - n)
                                          : 1e6;
  const Eigen::MatrixXd gradients =
      finite * sums.gradients + SystematicGradients(problem_given, state, jacobian, n);
  return inverse * gradients * inverse;
}

}  // namespace glint::light
