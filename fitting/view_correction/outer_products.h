// Sums of outer products of many rows with themselves, as normal equations are made of: what
// Eigen's matrix products do too, which are compiled for the processor's least vector units.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace glint {

class OuterProducts {
 public:
  explicit OuterProducts(int size);

  void Clear();
  // One more row, all of which the caller writes.
  Eigen::Map<Eigen::RowVectorXd> AddRow();
  // Adds `factor` · Σ rowᵀ·row to the lower triangle of `matrix`.
  void AddTo(double factor, Eigen::Ref<Eigen::MatrixXd> matrix);

 private:
  void Sum();

  int size_, stride_;
  int filled_ = 0;                   // rows not yet summed
  std::vector<double> rows_, sums_;  // rows of `stride_`; columns of it, whole below the diagonal
};

}  // namespace glint
