// Vectors of kLanes doubles and the functions on them that a texel's kernels need. Everything here
// is inlined into functions marked GLINT_VECTOR_CLONES, and so compiled for each vector unit.
#pragma once

#include <cstdint>
#include <cstring>

#include "base/cpu/vector_clones.h"
#include "fitting/texel/texel_observations.h"

namespace glint {
namespace {

using Lanes = double __attribute__((vector_size(kLanes * sizeof(double)), may_alias));

// log(x) for finite normal x > 0 within 1 ulp, without branches or calls so that loops over it
// vectorise: the reduction and the polynomial of FreeBSD's e_log.c.
[[gnu::always_inline]] inline double Log(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  // Exponent such that the mantissa is in [√½, √2).
  constexpr std::uint64_t kSqrtHalf = 0x3fe6a09e00000000u;
  const std::uint64_t shifted = bits - kSqrtHalf + 0x3ff0000000000000u;
  const std::uint64_t biased = shifted >> 52;
  const std::uint64_t mantissa = (shifted & 0x000fffffffffffffu) + kSqrtHalf;
  // An integer below 2^52 becomes a double by writing it into the mantissa of 2^52.
  const std::uint64_t exponent_bits = biased | 0x4330000000000000u;
  double exponent, m;
  std::memcpy(&exponent, &exponent_bits, sizeof exponent);
  std::memcpy(&m, &mantissa, sizeof m);
  exponent -= 4503599627370496.0 + 1023.0;

  const double f = m - 1.0;
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double w = z * z;
  const double odd = w * (3.999999999940941908e-01 +
                          w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const double even = z * (6.666666666666735130e-01 +
                           w * (2.857142874366239149e-01 +
                                w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const double half_square = 0.5 * f * f;
  return exponent * 6.93147180369123816490e-01 -
         ((half_square -
           (s * (half_square + (odd + even)) + exponent * 1.90821492927058770002e-10)) -
          f);
}

[[gnu::always_inline]] inline double Sum(const Lanes& lanes) {
  using Half = double __attribute__((vector_size(4 * sizeof(double))));
  using Quarter = double __attribute__((vector_size(2 * sizeof(double))));
  const Half half = __builtin_shufflevector(lanes, lanes, 0, 1, 2, 3) +
                    __builtin_shufflevector(lanes, lanes, 4, 5, 6, 7);
  const Quarter quarter =
      __builtin_shufflevector(half, half, 0, 1) + __builtin_shufflevector(half, half, 2, 3);
  return quarter[0] + quarter[1];
}

}  // namespace
}  // namespace glint
