#include <ceres/ceres.h>

#include <limits>
#include <memory>

#include "calib/light/light_cost.h"
#include "calib/light/spot_cost.h"

namespace glint::light {
namespace {

// (value − expected) / σ of each of N numbers.
template <int N>
class PriorCost {
 public:
  PriorCost(const Eigen::Matrix<double, N, 1>& expected, const Eigen::Matrix<double, N, 1>& sigma)
      : expected_(expected), sigma_(sigma) {}
  template <class T>
  bool operator()(const T* value, T* residual) const {
    for (int i = 0; i < N; ++i) residual[i] = (value[i] - T(expected_[i])) / T(sigma_[i]);
    return true;
  }

 private:
  Eigen::Matrix<double, N, 1> expected_, sigma_;
};

// Light that falls off like (1 + t·r²)⁻²: the polynomial nearest to it up to the corner, r = 1, has
// v2 and v3 as these functions of v1 (to 0.004 for corners that lose up to half of their light).
// The series' own first terms, 0.75·v1² and 0.5·v1³, would be 0.5 % off where corners lose 30 %.
struct FalloffPrior {
  template <class T>
  bool operator()(const T* v, T* residual) const {
    residual[0] = v[0] / T(kPrior.vignetting);
    const T square = v[0] * v[0];
    residual[1] = (v[1] - (T(0.766) + T(0.13) * v[0]) * square) / T(kPrior.vignetting_form);
    residual[2] = (v[2] - (T(0.45) + T(0.28) * v[0]) * square * v[0]) / T(kPrior.vignetting_form);
    return true;
  }
};

// Exposures hold to what EXIF says, mostly: the tail is for what EXIF does not know of.
struct ExifPrior {
  template <class T>
  bool operator()(const T* log_exposure, T* residual) const {
    const T mean = (log_exposure[0] + log_exposure[1] + log_exposure[2]) / T(3);
    residual[0] = (mean - T(log_exif)) / T(kPrior.exif);
    return true;
  }
  double log_exif;
};

// White balance is locked, mostly.
struct WhiteBalancePrior {
  template <class T>
  bool operator()(const T* log_exposure, T* residual) const {
    residual[0] = (log_exposure[0] - log_exposure[1]) / T(kPrior.white_balance);
    residual[1] = (log_exposure[2] - log_exposure[1]) / T(kPrior.white_balance);
    return true;
  }
};

template <int N>
void AddPrior(const Eigen::Matrix<double, N, 1>& expected, const Eigen::Matrix<double, N, 1>& sigma,
              double* block, ceres::Problem* problem) {
  problem->AddResidualBlock(
      new ceres::AutoDiffCostFunction<PriorCost<N>, N, N>(new PriorCost<N>(expected, sigma)),
      nullptr, block);
}

using Vector1 = Eigen::Matrix<double, 1, 1>;

}  // namespace

void AddSpots(bool robust, State* state, ceres::Problem* problem) {
  for (PhotoState& photo : state->photos) {
    if (!photo.used) continue;
    for (const Spot& spot : photo.spots) {
      if (!spot.inlier) continue;
      problem->AddResidualBlock(new SpotCost(spot, state->reference, state->weighing_scale()),
                                robust ? new ceres::CauchyLoss(2.0 / state->shared) : nullptr,
                                state->own_flashes ? photo.flash_mm.data() : state->flash_mm.data(),
                                state->log_q.data(), state->ambient.data(),
                                state->vignetting[photo.camera].data(), &state->gloss,
                                &state->smear, state->tone.data(), photo.log_exposure.data());
    }
  }
}

void AddPriors(const LightOptions& options, State* state, ceres::Problem* problem) {
  const double along = state->flash_along_free ? kPrior.flash_free_mm : kPrior.flash_along_mm;
  const Eigen::Vector3d flash_sigma(kPrior.flash_across_mm, kPrior.flash_across_mm, along);
  if (!state->own_flashes) {
    AddPrior<3>(options.offset_mm, flash_sigma, state->flash_mm.data(), problem);
  }
  AddPrior<3>(Eigen::Vector3d::Zero(),
              Eigen::Vector3d(kPrior.tone[0], kPrior.tone[1], kPrior.tone[2]), state->tone.data(),
              problem);
  AddPrior<3>(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(kPrior.ambient),
              state->ambient.data(), problem);
  AddPrior<1>(Vector1::Zero(), Vector1::Constant(kPrior.gloss), &state->gloss, problem);
  AddPrior<1>(Vector1::Zero(), Vector1::Constant(kPrior.smear), &state->smear, problem);
  for (size_t c = 0; c < state->vignetting.size(); ++c) {
    if (!problem->HasParameterBlock(state->vignetting[c].data())) continue;
    problem->AddResidualBlock(new ceres::AutoDiffCostFunction<FalloffPrior, 3, 3>(new FalloffPrior),
                              nullptr, state->vignetting[c].data());
  }
  for (PhotoState& photo : state->photos) {
    if (!photo.used) continue;
    problem->AddResidualBlock(
        new ceres::AutoDiffCostFunction<WhiteBalancePrior, 2, 3>(new WhiteBalancePrior),
        new ceres::CauchyLoss(2.0), photo.log_exposure.data());
    if (state->own_flashes) {
      AddPrior<3>(options.offset_mm, flash_sigma, photo.flash_mm.data(), problem);
    }
    if (photo.exif <= 0) continue;
    problem->AddResidualBlock(
        new ceres::AutoDiffCostFunction<ExifPrior, 1, 3>(new ExifPrior{std::log(photo.exif)}),
        new ceres::CauchyLoss(2.0), photo.log_exposure.data());
  }
}

void HoldBlocks(State* state, ceres::Problem* problem) {
  const auto hold = [problem](double* block) {
    if (problem->HasParameterBlock(block)) problem->SetParameterBlockConstant(block);
  };
  if (state->hold_flash) hold(state->flash_mm.data());
  if (state->hold_ambient) hold(state->ambient.data());
  if (state->hold_gloss) hold(&state->gloss);
  if (state->hold_tone) hold(state->tone.data());
  for (size_t c = 0; c < state->vignetting.size(); ++c) {
    if (state->hold_vignetting[c]) hold(state->vignetting[c].data());
  }
  hold(state->photos[state->first].log_exposure.data());
}

void Solve(const LightOptions& options, bool robust, State* state) {
  ceres::Problem problem;
  AddSpots(robust, state, &problem);
  AddPriors(options, state, &problem);
  HoldBlocks(state, &problem);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;  // the same bits for the same input
  solver.num_threads = 1;
  solver.max_num_iterations = 30;
  solver.function_tolerance = robust ? 1e-6 : 1e-10;
  solver.parameter_tolerance = 1e-10;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
}

double Misfit(const LightOptions& options, const State& solved, double scale) {
  State state = solved;
  state.scale = scale;
  for (PhotoState& photo : state.photos) {
    for (Spot& spot : photo.spots) spot.inlier = true;
  }
  ceres::Problem problem;
  AddSpots(true, &state, &problem);
  AddPriors(options, &state, &problem);
  double cost = 0;
  if (problem.Evaluate({}, &cost, nullptr, nullptr, nullptr)) return cost;
  return std::numeric_limits<double>::infinity();  // a spot that no light reaches
}

}  // namespace glint::light
