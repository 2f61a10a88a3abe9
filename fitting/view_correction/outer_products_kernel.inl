// The function of outer_products_kernel.h. Included by outer_products_kernel_<set>.cc, each
// compiled for its instruction set, after it has defined GLINT_VECTOR_BYTES and GLINT_KERNEL_NAME.
// Calls nothing that the linker could take from code compiled for another set
// (base/cpu/vectors.inl).
//
// A tile of the sums stays in registers while the rows pass: vectors as wide as the set's own,
// wider ones are kept in memory.

#if GLINT_VECTOR_BYTES > 16
#include <immintrin.h>
#endif

#include "fitting/view_correction/outer_products_kernel.h"

namespace glint::kernel {
namespace {

#include "base/cpu/vectors.inl"

constexpr int kTileColumns = 4, kTileVectors = 2;
constexpr int kTileRows = kTileVectors * kLanes<double>;
static_assert(kStrideUnit % kTileRows == 0 && kStrideUnit % kTileColumns == 0);

GLINT_INLINE Doubles Load(const double* from) {
  Doubles v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}

GLINT_INLINE void AddTile(const double* rows, int count, int stride, int column, int first,
                          double* sums) {
  Doubles tile[kTileColumns][kTileVectors];
  for (int c = 0; c < kTileColumns; ++c) {
    __builtin_memcpy(tile[c], sums + static_cast<long>(column + c) * stride + first,
                     sizeof tile[c]);
  }
  for (int k = 0; k < count; ++k) {
    const double* row = rows + static_cast<long>(k) * stride;
    const Doubles upper = Load(row + first), lower = Load(row + first + kLanes<double>);
    for (int c = 0; c < kTileColumns; ++c) {
      tile[c][0] += row[column + c] * upper;
      tile[c][1] += row[column + c] * lower;
    }
  }
  for (int c = 0; c < kTileColumns; ++c) {
    __builtin_memcpy(sums + static_cast<long>(column + c) * stride + first, tile[c],
                     sizeof tile[c]);
  }
}

void Add(const double* rows, int count, int stride, double* sums) {
  for (int column = 0; column < stride; column += kTileColumns) {
    for (int first = column / kTileRows * kTileRows; first < stride; first += kTileRows) {
      AddTile(rows, count, stride, column, first, sums);
    }
  }
}

}  // namespace

AddProducts GLINT_KERNEL_NAME() { return &Add; }

}  // namespace glint::kernel
