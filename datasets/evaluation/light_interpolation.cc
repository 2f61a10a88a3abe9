#include "datasets/evaluation/light_interpolation.h"

#include <Eigen/QR>
#include <cmath>

namespace glint {
namespace {

using Eigen::MatrixXd;
using Directions = std::vector<Eigen::Vector3d>;

MatrixXd PolynomialTerms(const Directions& lights) {
  MatrixXd terms(lights.size(), 6);
  for (size_t i = 0; i < lights.size(); ++i) {
    const double x = lights[i].x(), y = lights[i].y();
    terms.row(static_cast<Eigen::Index>(i)) << x * x, y * y, x * y, x, y, 1;
  }
  return terms;
}

// Up to factors, which least squares do not see.
MatrixXd HarmonicTerms(const Directions& lights, int terms) {
  MatrixXd basis(lights.size(), 16);
  for (size_t i = 0; i < lights.size(); ++i) {
    const double x = lights[i].x(), y = lights[i].y(), z = lights[i].z();
    basis.row(static_cast<Eigen::Index>(i)) << 1, x, y, z, x * y, y * z, 3 * z * z - 1, x * z,
        x * x - y * y, y * (3 * x * x - y * y), x * y * z, y * (5 * z * z - 1), z * (5 * z * z - 3),
        x * (5 * z * z - 1), z * (x * x - y * y), x * (x * x - 3 * y * y);
  }
  return basis.leftCols(terms);
}

// Weights of least squares: terms(wanted) · terms(known)⁺.
MatrixXd Fitted(const MatrixXd& known, const MatrixXd& wanted) {
  return wanted * known.completeOrthogonalDecomposition().pseudoInverse();
}

double ThinPlate(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double square = (a - b).head<2>().squaredNorm();
  return square > 0 ? square * std::log(square) : 0;
}

MatrixXd SplineWeights(const Directions& known, const Directions& wanted) {
  const auto n = static_cast<Eigen::Index>(known.size());
  const auto m = static_cast<Eigen::Index>(wanted.size());
  MatrixXd system = MatrixXd::Zero(n + 3, n + 3), at = MatrixXd::Zero(m, n + 3);
  const auto affine = [](const Eigen::Vector3d& light) {
    return Eigen::RowVector3d(1, light.x(), light.y());
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d& light = known[static_cast<size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j) {
      system(i, j) = ThinPlate(light, known[static_cast<size_t>(j)]);
    }
    system.block<1, 3>(i, n) = affine(light);
    system.block<3, 1>(n, i) = affine(light).transpose();
  }
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Vector3d& light = wanted[static_cast<size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j) {
      at(i, j) = ThinPlate(light, known[static_cast<size_t>(j)]);
    }
    at.block<1, 3>(i, n) = affine(light);
  }
  return (at * system.completeOrthogonalDecomposition().pseudoInverse()).leftCols(n);
}

}  // namespace

const std::vector<LightInterpolation>& LightInterpolations() {
  static const std::vector<LightInterpolation> all = {
      {"ptm",
       [](const Directions& known, const Directions& wanted) {
         return Fitted(PolynomialTerms(known), PolynomialTerms(wanted));
       }},
      {"sh9",
       [](const Directions& known, const Directions& wanted) {
         return Fitted(HarmonicTerms(known, 9), HarmonicTerms(wanted, 9));
       }},
      {"sh16",
       [](const Directions& known, const Directions& wanted) {
         return Fitted(HarmonicTerms(known, 16), HarmonicTerms(wanted, 16));
       }},
      {"rbf", SplineWeights}};
  return all;
}

}  // namespace glint
