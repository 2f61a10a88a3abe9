#include "calib/registration/factor_analysis.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/model/registration.h"
#include "base/model/solver.h"

namespace glint {

int FactorsOf(int views) {
  int factors = constants::kMostFactors;
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
  const double least = constants::kLeastTexture * sample.diagonal().maxCoeff();
  return FactorsOf(static_cast<int>((sample.diagonal().array() > least).count()));
}

FactorModel FitFactors(const Eigen::MatrixXd& sample, int factors) {
  const Eigen::MatrixXd correlation = CorrelationOf(sample);
  Eigen::VectorXd noise = Eigen::VectorXd::Constant(sample.rows(), constants::kFirstTextureNoise);
  Eigen::MatrixXd loadings;
  for (int step = 0; step < constants::kFactorSteps; ++step) {
    const Eigen::VectorXd root = noise.cwiseSqrt(), inverse_root = root.cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
        inverse_root.asDiagonal() * correlation * inverse_root.asDiagonal());
    loadings = root.asDiagonal() * eigen.eigenvectors().rightCols(factors) *
               (eigen.eigenvalues().tail(factors).array() - 1).max(0).sqrt().matrix().asDiagonal();
    noise =
        (1 - loadings.rowwise().squaredNorm().array()).max(constants::kLeastTextureNoise).min(1);
  }
  Eigen::MatrixXd model = loadings * loadings.transpose();
  model.diagonal() += noise;
  const Eigen::LLT<Eigen::MatrixXd> root(model);
  const Eigen::VectorXd deviations = DeviationsOf(sample);
  return {deviations.asDiagonal() * model * deviations.asDiagonal(),
          2 * root.matrixLLT().diagonal().array().log().sum() + root.solve(correlation).trace()};
}

}  // namespace glint
