#include "fitting/view_correction/outer_products.h"

#include <algorithm>
#include <cstring>

#include "base/cpu/vector_clones.h"

namespace glint {
namespace {

// Rows that are summed at once: those of a tile stay in the first cache.
constexpr int kRows = 144;
// A tile of the sums is kept in registers.
constexpr int kTileColumns = 4, kTileRows = 16;

typedef double Vector __attribute__((vector_size(64), aligned(8)));
constexpr int kVector = 8;
static_assert(kTileRows == 2 * kVector);

// sums += rowsᵀ·rows, tiles wholly above the diagonal left out. `stride` is a multiple of the
// tile's sides.
GLINT_VECTOR_CLONES
void AddProducts(const double* rows, int count, int stride, double* sums) {
  for (int column = 0; column < stride; column += kTileColumns) {
    for (int first = column / kTileRows * kTileRows; first < stride; first += kTileRows) {
      Vector tile[kTileColumns][2];
      for (int c = 0; c < kTileColumns; ++c) {
        std::memcpy(tile[c], sums + static_cast<std::ptrdiff_t>(column + c) * stride + first,
                    sizeof tile[c]);
      }
      for (int k = 0; k < count; ++k) {
        const double* row = rows + static_cast<std::ptrdiff_t>(k) * stride;
        const Vector& upper = *reinterpret_cast<const Vector*>(row + first);
        const Vector& lower = *reinterpret_cast<const Vector*>(row + first + kVector);
        for (int c = 0; c < kTileColumns; ++c) {
          tile[c][0] += row[column + c] * upper;
          tile[c][1] += row[column + c] * lower;
        }
      }
      for (int c = 0; c < kTileColumns; ++c) {
        std::memcpy(sums + static_cast<std::ptrdiff_t>(column + c) * stride + first, tile[c],
                    sizeof tile[c]);
      }
    }
  }
}

}  // namespace

OuterProducts::OuterProducts(int size)
    : size_(size),
      stride_((size + kTileRows - 1) / kTileRows * kTileRows),
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
  AddProducts(rows_.data(), filled_, stride_, sums_.data());
  filled_ = 0;
}

void OuterProducts::AddTo(double factor, Eigen::Ref<Eigen::MatrixXd> matrix) {
  Sum();
  const Eigen::Map<const Eigen::MatrixXd> sums(sums_.data(), stride_, stride_);
  matrix.triangularView<Eigen::Lower>() += factor * sums.topLeftCorner(size_, size_);
}

}  // namespace glint
