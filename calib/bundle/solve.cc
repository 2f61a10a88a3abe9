#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/normal_prior.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "base/errors/errors.h"
#include "calib/bundle/bundle_internal.h"
#include "calib/bundle/cost.h"

namespace glint::bundle {

namespace {

// Ceres logs through glog, which by default writes files to /tmp.
void QuietGlog() {
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = 2;
}

// What Ceres holds constant of a camera's block: all that is not free.
void HoldParameters(const BundleProblem& problem, const BundleOptions& options, Refine refine,
                    int camera, double* block, ceres::Problem* solver) {
  std::vector<int> free = FreeParameters(problem, options, camera);
  const auto& names = CameraParameterNames(options.model);
  if (refine == Refine::kFocalAndPoses) {
    std::erase_if(free,
                  [&](int i) { return i >= static_cast<int>(FocalLengthCount(options.model)); });
  }
  if (free.empty()) {
    solver->SetParameterBlockConstant(block);
    return;
  }
  std::vector<int> held;
  for (int i = 0; i < static_cast<int>(names.size()); ++i) {
    if (std::find(free.begin(), free.end(), i) == free.end()) held.push_back(i);
  }
  if (!held.empty()) {
    solver->SetManifold(block, new ceres::SubsetManifold(static_cast<int>(names.size()), held));
  }
}

void AddPrior(const Camera& camera, const std::vector<int>& free, double sigma_px,
              ceres::Problem* solver, double* block) {
  const auto prior = DistortionPrior(camera, free);
  if (prior.empty()) return;
  const auto n = static_cast<long>(camera.parameters.size());
  ceres::Matrix weights = ceres::Matrix::Zero(static_cast<long>(prior.size()), n);
  for (size_t i = 0; i < prior.size(); ++i) {
    weights(static_cast<long>(i), prior[i].first) = sigma_px * prior[i].second;
  }
  solver->AddResidualBlock(new ceres::NormalPrior(weights, ceres::Vector::Zero(n)), nullptr, block);
}

void AddBendPrior(double sigma_px, BoardBend* bend, ceres::Problem* solver) {
  const ceres::Matrix weights = ceres::Matrix::Identity(2, 2) * (sigma_px / BendPriorSigma(*bend));
  solver->AddResidualBlock(new ceres::NormalPrior(weights, ceres::Vector::Zero(2)), nullptr,
                           bend->height_mm.data());
}

// The cost of every accepted inlier; returns which cameras have any.
std::vector<bool> AddCorners(const BundleProblem& problem, bool bend_is_free,
                             ceres::LossFunction* loss, State* state, ceres::Problem* solver) {
  std::vector<bool> used(problem.cameras.size(), false);
  for (size_t i = 0; i < problem.photos.size(); ++i) {
    const BundlePhoto& photo = problem.photos[i];
    PhotoState& photo_state = state->photos[i];
    if (!photo_state.accepted) continue;
    Camera& camera = state->cameras[photo.camera];
    for (size_t k = 0; k < photo.corners.size(); ++k) {
      if (!photo_state.inlier[k]) continue;
      std::vector<double*> blocks = {camera.parameters.data(), photo_state.pose.data()};
      if (bend_is_free) blocks.push_back(state->bend.height_mm.data());
      solver->AddResidualBlock(
          MakeCost(camera.model, photo_state.rotation0, photo.corners[k], state->bend, bend_is_free)
              .release(),
          loss, blocks);
      used[photo.camera] = true;
    }
  }
  return used;
}

ceres::Solver::Options SolverOptions(const BundleOptions& options) {
  ceres::Solver::Options solver_options;
  solver_options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver_options.num_threads = 1;
  solver_options.max_num_iterations = options.max_iterations;
  solver_options.function_tolerance = 1e-14;
  solver_options.gradient_tolerance = 1e-14;
  solver_options.parameter_tolerance = 1e-12;
  solver_options.logging_type = ceres::SILENT;
  return solver_options;
}

}  // namespace

Rigid3 PhotoState::camera_from_sample() const {
  Rigid3 rigid;
  const Eigen::Vector3d w(pose[0], pose[1], pose[2]);
  const double angle = w.norm();
  rigid.rotation =
      angle > 0 ? Eigen::Matrix3d(Eigen::AngleAxisd(angle, w / angle) * rotation0) : rotation0;
  rigid.translation = {pose[3], pose[4], pose[5]};
  return rigid;
}

void PhotoState::Rebase() {
  // Through a unit quaternion, so that rounding does not build up.
  rotation0 = Eigen::Quaterniond(camera_from_sample().rotation).normalized().toRotationMatrix();
  pose[0] = pose[1] = pose[2] = 0;
}

std::vector<int> FreeParameters(const BundleProblem& problem, const BundleOptions& options,
                                int camera) {
  std::vector<int> free;
  if (problem.cameras[camera].known) return free;
  const auto& names = CameraParameterNames(options.model);
  for (int i = 0; i < static_cast<int>(names.size()); ++i) {
    if (std::find(options.hold.begin(), options.hold.end(), names[i]) == options.hold.end()) {
      free.push_back(i);
    }
  }
  return free;
}

std::vector<std::pair<int, double>> DistortionPrior(const Camera& camera,
                                                    const std::vector<int>& free) {
  constexpr double kShare = 0.5;
  const auto& parameters = InfoOf(camera.model).parameters;
  const double focal = camera.focal_length_x();
  const double r2 = 0.25 *
                    (camera.width_px * static_cast<double>(camera.width_px) +
                     camera.height_px * static_cast<double>(camera.height_px)) /
                    (focal * focal);
  std::vector<std::pair<int, double>> prior;
  for (const int i : free) {
    const CameraParameter& parameter = parameters[static_cast<size_t>(i)];
    if (parameter.kind == CameraParameter::kRadial) {
      prior.emplace_back(i, std::pow(r2, parameter.power) / kShare);
    }
  }
  return prior;
}

void Solve(const BundleProblem& problem, const BundleOptions& options, Refine refine,
           double loss_scale_px, double sigma_px, State* state) {
  QuietGlog();
  for (PhotoState& photo : state->photos) photo.Rebase();
  std::unique_ptr<ceres::LossFunction> loss;
  if (loss_scale_px > 0) loss = std::make_unique<ceres::CauchyLoss>(loss_scale_px);
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem solver(problem_options);
  const bool bend_is_free = options.bend && refine == Refine::kAll;
  const std::vector<bool> used = AddCorners(problem, bend_is_free, loss.get(), state, &solver);
  if (bend_is_free) AddBendPrior(sigma_px, &state->bend, &solver);
  for (size_t c = 0; c < used.size(); ++c) {
    if (!used[c]) continue;
    Camera& camera = state->cameras[c];
    HoldParameters(problem, options, refine, static_cast<int>(c), camera.parameters.data(),
                   &solver);
    AddPrior(camera, FreeParameters(problem, options, static_cast<int>(c)), sigma_px, &solver,
             camera.parameters.data());
  }
  ceres::Solver::Summary summary;
  ceres::Solve(SolverOptions(options), &solver, &summary);
  if (!summary.IsSolutionUsable()) {
    throw ComputationError("the bundle adjustment failed: " + summary.message +
                           "; check the board corners found in the photographs");
  }
}

}  // namespace glint::bundle
