#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib/bundle/bundle_internal.h"
#include "calib/bundle/cost.h"

namespace glint::bundle {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Poses meet only in what they share: their camera and, where it is solved for, the board's bend.
// What is shared by photos that meet is a system of its own. Without a bend each camera is one.
struct System {
  struct Part {
    int camera = 0;
    std::vector<int> free;  // parameters of the camera
    long first = 0;         // column of the first of them
  };
  std::vector<Part> parts;
  bool bend = false;  // the last two columns
  long columns = 0;
};

void AddCamera(const BundleProblem& problem, const BundleOptions& options, int camera,
               System* system) {
  System::Part part{camera, FreeParameters(problem, options, camera), system->columns};
  system->columns += static_cast<long>(part.free.size());
  system->parts.push_back(std::move(part));
}

std::vector<System> Systems(const BundleProblem& problem, const BundleOptions& options,
                            const BundleResult& result) {
  std::vector<System> systems;
  for (size_t c = 0; c < problem.cameras.size(); ++c) {
    if (result.cameras[c].photos == 0) continue;
    if (systems.empty() || !options.bend) systems.emplace_back();
    AddCamera(problem, options, static_cast<int>(c), &systems.back());
  }
  if (options.bend && !systems.empty()) {
    systems[0].bend = true;
    systems[0].columns += 2;
  }
  return systems;
}

// Jacobian of one photo's inliers: by its pose, and by what its system shares.
struct Jacobian {
  Eigen::MatrixXd pose, shared;
};

Jacobian PhotoJacobian(const BundlePhoto& photo, const State& state, const PhotoState& photo_state,
                       const System& system, const System::Part& part) {
  const Camera& camera = state.cameras[photo.camera];
  const int all = static_cast<int>(camera.parameters.size());
  const auto inliers = std::count(photo_state.inlier.begin(), photo_state.inlier.end(), true);
  Jacobian jacobian{Eigen::MatrixXd::Zero(2 * inliers, 6),
                    Eigen::MatrixXd::Zero(2 * inliers, system.columns)};
  Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor> j_camera(2, all);
  Eigen::Matrix<double, 2, 6, Eigen::RowMajor> j_pose;
  Eigen::Matrix<double, 2, 2, Eigen::RowMajor> j_bend;
  long row = 0;
  for (size_t k = 0; k < photo.corners.size(); ++k) {
    if (!photo_state.inlier[k]) continue;
    const auto cost =
        MakeCost(camera.model, photo_state.rotation0, photo.corners[k], state.bend, system.bend);
    const double* parameters[] = {camera.parameters.data(), photo_state.pose.data(),
                                  state.bend.height_mm.data()};
    double* jacobians[] = {j_camera.data(), j_pose.data(), j_bend.data()};
    double residual[2];
    if (cost->Evaluate(parameters, residual, jacobians)) {
      jacobian.pose.middleRows<2>(row) = j_pose;
      for (size_t i = 0; i < part.free.size(); ++i) {
        jacobian.shared.col(part.first + static_cast<long>(i)).segment<2>(row) =
            j_camera.col(part.free[i]);
      }
      if (system.bend) jacobian.shared.block<2, 2>(row, system.columns - 2) = j_bend;
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
  if (n == 0) return Eigen::MatrixXd(0, 0);
  if (j.rows() <= n) return j;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(j);
  return qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
}

// A photo's part of a system: the pose moves by −link · (motion of what is shared).
struct PhotoLink {
  size_t photo;
  const System::Part* part;
  Eigen::MatrixXd link;
  Matrix6 own;  // covariance of the pose with all that is shared held
};

// The rows that remain of a system when all poses are eliminated (Schur's complement).
Eigen::MatrixXd Reduce(const BundleProblem& problem, const State& state, const System& system,
                       std::vector<PhotoLink>* links) {
  Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(0, system.columns);
  for (const System::Part& part : system.parts) {
    for (size_t i = 0; i < problem.photos.size(); ++i) {
      if (problem.photos[i].camera != part.camera || !state.photos[i].accepted) continue;
      const Jacobian j = PhotoJacobian(problem.photos[i], state, state.photos[i], system, part);
      // Without shared unknowns there is nothing to solve for (Eigen would touch what is not
      // there).
      Eigen::MatrixXd link(j.pose.cols(), system.columns);
      if (system.columns > 0) link = j.pose.householderQr().solve(j.shared);
      // What of the shared unknowns' effect no change of the pose can imitate.
      const Eigen::MatrixXd own = j.shared - j.pose * link;
      Eigen::MatrixXd stacked(reduced.rows() + own.rows(), system.columns);
      stacked << reduced, own;
      reduced = Triangle(stacked);
      const auto pose = InverseNormal(j.pose);
      if (pose) links->push_back({i, &part, link, *pose});
    }
  }
  return reduced;
}

// Residual rows of the priors: see DistortionPrior and BendPriorSigma.
Eigen::MatrixXd WithPriors(const Eigen::MatrixXd& reduced, const State& state, const System& system,
                           double sigma_px) {
  std::vector<std::pair<long, double>> priors;
  for (const System::Part& part : system.parts) {
    for (const auto& [index, weight] : DistortionPrior(state.cameras[part.camera], part.free)) {
      const auto at = std::find(part.free.begin(), part.free.end(), index) - part.free.begin();
      priors.emplace_back(part.first + at, weight);
    }
  }
  if (system.bend) {
    const double weight = 1 / BendPriorSigma(state.bend);
    priors.insert(priors.end(), {{system.columns - 2, weight}, {system.columns - 1, weight}});
  }
  Eigen::MatrixXd rows =
      Eigen::MatrixXd::Zero(reduced.rows() + static_cast<long>(priors.size()), system.columns);
  rows.topRows(reduced.rows()) = reduced;
  for (size_t i = 0; i < priors.size(); ++i) {
    rows(reduced.rows() + static_cast<long>(i), priors[i].first) = sigma_px * priors[i].second;
  }
  return rows;
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
void FillPhoto(const PhotoLink& link, const Eigen::MatrixXd& shared, double variance,
               size_t parameters, PhotoEstimate* estimate) {
  const Eigen::MatrixXd with_shared = -link.link * shared;
  estimate->covariance = link.own * variance - with_shared * link.link.transpose();
  estimate->covariance_with_camera = Eigen::MatrixXd::Zero(6, static_cast<long>(parameters));
  for (size_t i = 0; i < link.part->free.size(); ++i) {
    estimate->covariance_with_camera.col(link.part->free[i]) =
        with_shared.col(link.part->first + static_cast<long>(i));
  }
  const Eigen::Vector3d& t = estimate->camera_from_sample.translation;
  Eigen::Matrix3d cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  Eigen::Matrix<double, 3, 6> motion;
  motion << -cross, -Eigen::Matrix3d::Identity();  // Rᵀ keeps the trace
  estimate->sigma_position_mm =
      std::sqrt((motion * estimate->covariance * motion.transpose()).trace() / 3);
  estimate->sigma_rotation_deg =
      std::sqrt(estimate->covariance.topLeftCorner<3, 3>().trace() / 3) * 180 / std::numbers::pi;
}

double ResidualVariance(const BundleProblem& problem, const BundleOptions& options,
                        const BundleResult& result) {
  int unknowns = options.bend ? 2 : 0;
  for (size_t c = 0; c < problem.cameras.size(); ++c) {
    if (result.cameras[c].photos == 0) continue;
    unknowns += static_cast<int>(FreeParameters(problem, options, static_cast<int>(c)).size()) +
                6 * result.cameras[c].photos;
  }
  const double freedom = std::max(1, 2 * result.inliers - unknowns);
  return result.rms_px * result.rms_px * result.inliers / freedom;
}

// The largest relative standard deviation of a focal length; `unit` is for residuals of 1 px.
double FocalSigma(const Camera& camera, const System::Part& part, const Eigen::MatrixXd& unit,
                  double variance) {
  constexpr double kLeastResidual_px = 0.05;
  const double least = std::max(variance, kLeastResidual_px * kLeastResidual_px);
  double sigma = 0;
  for (size_t i = 0; i < part.free.size(); ++i) {
    if (part.free[i] >= static_cast<int>(FocalLengthCount(camera.model))) continue;
    const long at = part.first + static_cast<long>(i);
    sigma = std::max(sigma,
                     std::sqrt(unit(at, at) * least) / std::abs(camera.parameters[part.free[i]]));
  }
  return sigma;
}

}  // namespace

std::vector<double> Covariance(const BundleProblem& problem, const BundleOptions& options,
                               const State& state, BundleResult* result) {
  const double variance = ResidualVariance(problem, options, *result);
  result->sigma_px = std::sqrt(variance);
  std::vector<double> focal_sigmas(problem.cameras.size(), 0);
  for (CameraEstimate& estimate : result->cameras) FillCamera({}, {}, &estimate);
  for (const System& system : Systems(problem, options, *result)) {
    std::vector<PhotoLink> links;
    const Eigen::MatrixXd reduced = Reduce(problem, state, system, &links);
    const auto unit = InverseNormal(WithPriors(reduced, state, system, result->sigma_px));
    for (const System::Part& part : system.parts) {
      CameraEstimate* estimate = &result->cameras[part.camera];
      const long n = static_cast<long>(part.free.size());
      FillCamera(
          unit ? part.free : std::vector<int>(),
          unit ? (unit->block(part.first, part.first, n, n) * variance).eval() : Eigen::MatrixXd(),
          estimate);
      focal_sigmas[part.camera] =
          unit ? FocalSigma(estimate->camera, part, *unit, variance) : INFINITY;
    }
    if (!unit) continue;
    const Eigen::MatrixXd shared = *unit * variance;
    if (system.bend) result->bend->covariance = shared.bottomRightCorner<2, 2>();
    for (const PhotoLink& link : links) {
      const size_t parameters = state.cameras[link.part->camera].parameters.size();
      FillPhoto(link, shared, variance, parameters, &result->photos[link.photo]);
    }
  }
  return focal_sigmas;
}

}  // namespace glint::bundle
