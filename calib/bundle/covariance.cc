#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib/bundle/bundle_internal.h"
#include "calib/bundle/cost.h"

namespace glint::bundle {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Jacobian of one photo's inliers: by its pose, and by the camera's free parameters.
struct Jacobian {
  Eigen::MatrixXd pose, camera;
};

Jacobian PhotoJacobian(const BundlePhoto& photo, const Camera& camera, const PhotoState& state,
                       const std::vector<int>& free) {
  const int all = static_cast<int>(camera.parameters.size());
  const int n = static_cast<int>(free.size());
  const auto inliers = std::count(state.inlier.begin(), state.inlier.end(), true);
  Jacobian jacobian{Eigen::MatrixXd::Zero(2 * inliers, 6), Eigen::MatrixXd::Zero(2 * inliers, n)};
  Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor> j_camera(2, all);
  Eigen::Matrix<double, 2, 6, Eigen::RowMajor> j_pose;
  long row = 0;
  for (size_t k = 0; k < photo.corners.size(); ++k) {
    if (!state.inlier[k]) continue;
    const auto cost = MakeCost(camera.model, state.rotation0, photo.corners[k]);
    const double* parameters[] = {camera.parameters.data(), state.pose.data()};
    double* jacobians[] = {j_camera.data(), j_pose.data()};
    double residual[2];
    if (cost->Evaluate(parameters, residual, jacobians)) {
      jacobian.pose.middleRows<2>(row) = j_pose;
      for (int i = 0; i < n; ++i) jacobian.camera.col(i).segment<2>(row) = j_camera.col(free[i]);
    }
    row += 2;
  }
  return jacobian;
}

// (JᵀJ)⁻¹ by the singular values of J with columns scaled to 1; nullopt: singular. Through J and
// not JᵀJ, whose condition is the square: FULL_OPENCV's eight distortion terms are nearly
// dependent.
std::optional<Eigen::MatrixXd> InverseNormal(const Eigen::MatrixXd& j) {
  const long n = j.cols();
  if (n == 0) return Eigen::MatrixXd(0, 0);
  if (j.rows() < n) return std::nullopt;
  const Eigen::VectorXd scale = j.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(j * scale.asDiagonal(), Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  if (!(s[n - 1] > 1e-11 * s[0])) return std::nullopt;
  const Eigen::MatrixXd root = scale.asDiagonal() * svd.matrixV() * s.cwiseInverse().asDiagonal();
  return Eigen::MatrixXd(root * root.transpose());
}

// The upper triangle R of a QR decomposition: as many rows as columns, same RᵀR.
Eigen::MatrixXd Triangle(const Eigen::MatrixXd& j) {
  const long n = j.cols();
  if (j.rows() <= n) return j;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(j);
  return qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
}

void FillCamera(const std::vector<int>& free, const Eigen::MatrixXd& covariance,
                CameraEstimate* estimate) {
  const int all = static_cast<int>(estimate->camera.parameters.size());
  estimate->sigma.assign(all, 0);
  estimate->covariance = Eigen::MatrixXd::Zero(all, all);
  for (size_t i = 0; i < free.size(); ++i) {
    for (size_t j = 0; j < free.size(); ++j) {
      estimate->covariance(free[i], free[j]) = covariance(i, j);
    }
    estimate->sigma[free[i]] = std::sqrt(covariance(i, i));
  }
}

// The camera's centre −Rᵀt moves by Rᵀ(w × t) − Rᵀ δt when the pose moves by (w, δt).
void FillPhoto(const Matrix6& covariance, PhotoEstimate* estimate) {
  const Eigen::Vector3d& t = estimate->camera_from_sample.translation;
  Eigen::Matrix3d cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  Eigen::Matrix<double, 3, 6> motion;
  motion << -cross, -Eigen::Matrix3d::Identity();  // Rᵀ keeps the trace
  estimate->sigma_position_mm = std::sqrt((motion * covariance * motion.transpose()).trace() / 3);
  estimate->sigma_rotation_deg =
      std::sqrt(covariance.topLeftCorner<3, 3>().trace() / 3) * 180 / std::numbers::pi;
}

}  // namespace

std::vector<double> Covariance(const BundleProblem& problem, const BundleOptions& options,
                               const State& state, BundleResult* result) {
  constexpr double kLeastResidual_px = 0.05;
  // Poses meet only in their camera, so that each camera with its photos is a system of its own,
  // and the camera's part of it is found by eliminating one pose after the other (Schur's
  // complement).
  std::vector<double> focal_sigmas(problem.cameras.size(), 0);
  int unknowns = 0;
  for (size_t c = 0; c < problem.cameras.size(); ++c) {
    if (result->cameras[c].photos > 0) {
      unknowns += static_cast<int>(FreeParameters(problem, options, static_cast<int>(c)).size()) +
                  6 * result->cameras[c].photos;
    }
  }
  const double freedom = std::max(1, 2 * result->inliers - unknowns);
  const double variance = result->rms_px * result->rms_px * result->inliers / freedom;
  for (size_t c = 0; c < problem.cameras.size(); ++c) {
    const auto free = FreeParameters(problem, options, static_cast<int>(c));
    const long n = static_cast<long>(free.size());
    std::vector<std::pair<size_t, Jacobian>> photos;
    Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(0, n);
    for (size_t i = 0; i < problem.photos.size(); ++i) {
      if (problem.photos[i].camera != static_cast<int>(c) || !state.photos[i].accepted) continue;
      Jacobian j = PhotoJacobian(problem.photos[i], state.cameras[c], state.photos[i], free);
      // What of the camera's effect no change of the pose can imitate.
      const Eigen::MatrixXd own = j.camera - j.pose * j.pose.householderQr().solve(j.camera);
      Eigen::MatrixXd stacked(reduced.rows() + own.rows(), n);
      stacked << reduced, own;
      reduced = Triangle(stacked);
      photos.emplace_back(i, std::move(j));
    }
    const auto prior = DistortionPrior(state.cameras[c], free);
    Eigen::MatrixXd with_prior =
        Eigen::MatrixXd::Zero(reduced.rows() + static_cast<long>(prior.size()), n);
    with_prior.topRows(reduced.rows()) = reduced;
    for (size_t i = 0; i < prior.size(); ++i) {
      const long column = std::find(free.begin(), free.end(), prior[i].first) - free.begin();
      with_prior(reduced.rows() + static_cast<long>(i), column) =
          std::sqrt(variance) * prior[i].second;
    }
    const auto camera = InverseNormal(with_prior);
    if (!camera) {
      focal_sigmas[c] = INFINITY;
      FillCamera({}, {}, &result->cameras[c]);
      continue;
    }
    FillCamera(free, *camera * variance, &result->cameras[c]);
    for (const auto& [i, j] : photos) {
      const auto pose = InverseNormal(j.pose);
      if (!pose) continue;
      const Eigen::MatrixXd link = j.pose.householderQr().solve(j.camera);
      FillPhoto((*pose + link * *camera * link.transpose()) * variance, &result->photos[i]);
    }
    const double least = std::max(variance, kLeastResidual_px * kLeastResidual_px);
    const auto& names = CameraParameterNames(state.cameras[c].model);
    for (long i = 0; i < n; ++i) {
      if (names[free[i]][0] != 'f') continue;
      const double relative =
          std::sqrt((*camera)(i, i) * least) / std::abs(state.cameras[c].parameters[free[i]]);
      focal_sigmas[c] = std::max(focal_sigmas[c], relative);
    }
  }
  return focal_sigmas;
}

}  // namespace glint::bundle
