// sums += rowsᵀ·rows, compiled for each instruction set; the same bits from all of them.
#pragma once

#include "base/cpu/instruction_set.h"

namespace glint::kernel {

// A row's length with its padding is a multiple of this.
inline constexpr int kStrideUnit = 16;

// `rows`: `count` of them, `stride` apart. `sums`: columns `stride` apart, of which what lies
// on and below the diagonal is summed, and some of what is above.
using AddProducts = void (*)(const double* rows, int count, int stride, double* sums);
AddProducts AddProductsFor(InstructionSet set);

}  // namespace glint::kernel
