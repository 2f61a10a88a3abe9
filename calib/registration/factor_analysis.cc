#include "calib/registration/factor_analysis.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr int kMostFactors = 3;  // albedo and two slopes
constexpr int kSteps = 10;       // misfits change by less than theirs from place to place after it
constexpr double kLeastNoise = 0.003;  // of a view's variance: JPEG and resampling
constexpr double kFirstNoise = 0.5;

}  // namespace

int FactorsOf(int views) {
  int factors = kMostFactors;
  while (factors > 0 && (views - factors) * (views - factors) <= views + factors) --factors;
  return factors;
}

namespace {

Eigen::VectorXd DeviationsOf(const Eigen::MatrixXd& sample) {
  return (sample.diagonal().array() + 1e-12).sqrt();
}

Eigen::MatrixXd CorrelationOf(const Eigen::MatrixXd& sample) {
  const Eigen::VectorXd inverse = DeviationsOf(sample).cwiseInverse();
  Eigen::MatrixXd correlation = inverse.asDiagonal() * sample * inverse.asDiagonal();
  correlation.diagonal().setOnes();  // of views that show nothing too
  return correlation;
}

}  // namespace

int FactorsOf(const Eigen::MatrixXd& sample) {
  constexpr double kLeastTexture = 1e-4;  // of the largest variance
  const double least = kLeastTexture * sample.diagonal().maxCoeff();
  return FactorsOf(static_cast<int>((sample.diagonal().array() > least).count()));
}

FactorModel FitFactors(const Eigen::MatrixXd& sample, int factors) {
  const Eigen::MatrixXd correlation = CorrelationOf(sample);
  Eigen::VectorXd noise = Eigen::VectorXd::Constant(sample.rows(), kFirstNoise);
  Eigen::MatrixXd loadings;
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::VectorXd root = noise.cwiseSqrt(), inverse_root = root.cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
        inverse_root.asDiagonal() * correlation * inverse_root.asDiagonal());
    loadings = root.asDiagonal() * eigen.eigenvectors().rightCols(factors) *
               (eigen.eigenvalues().tail(factors).array() - 1).max(0).sqrt().matrix().asDiagonal();
    noise = (1 - loadings.rowwise().squaredNorm().array()).max(kLeastNoise).min(1);
  }
  Eigen::MatrixXd model = loadings * loadings.transpose();
  model.diagonal() += noise;
  const Eigen::LLT<Eigen::MatrixXd> root(model);
  const Eigen::VectorXd deviations = DeviationsOf(sample);
  return {deviations.asDiagonal() * model * deviations.asDiagonal(),
          2 * root.matrixLLT().diagonal().array().log().sum() + root.solve(correlation).trace()};
}

}  // namespace glint
