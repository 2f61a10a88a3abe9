#include "fitting/view_correction/outer_products.h"

#include <algorithm>

#include "fitting/view_correction/outer_products_kernel.h"

namespace glint {
namespace {

// Rows that are summed at once: those of a tile stay in the first cache.
constexpr int kRows = 144;

}  // namespace

OuterProducts::OuterProducts(int size)
    : size_(size),
      stride_((size + kernel::kStrideUnit - 1) / kernel::kStrideUnit * kernel::kStrideUnit),
      rows_(static_cast<size_t>(kRows) * stride_),
      sums_(static_cast<size_t>(stride_) * stride_) {}

void OuterProducts::Clear() {
  filled_ = 0;
  std::fill(sums_.begin(), sums_.end(), 0.0);
}

Eigen::Map<Eigen::RowVectorXd> OuterProducts::AddRow() {
  if (filled_ == kRows) Sum();
  return {rows_.data() + static_cast<std::ptrdiff_t>(filled_++) * stride_, size_};
}

void OuterProducts::Sum() {
  static const kernel::AddProducts add = kernel::AddProductsFor(BestInstructionSet());
  add(rows_.data(), filled_, stride_, sums_.data());
  filled_ = 0;
}

void OuterProducts::AddTo(double factor, Eigen::Ref<Eigen::MatrixXd> matrix) {
  Sum();
  const Eigen::Map<const Eigen::MatrixXd> sums(sums_.data(), stride_, stride_);
  matrix.triangularView<Eigen::Lower>() += factor * sums.topLeftCorner(size_, size_);
}

}  // namespace glint
