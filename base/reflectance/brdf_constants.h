// Constants of the reflectance model (brdf.h). Apart, and without the standard library, because the
// vector kernels of fitting/render include them where no library code may come in.
#pragma once

namespace glint {

inline constexpr double kDotClamp = 1e-8;           // lower bound of every dot product
inline constexpr double kDenominatorClamp = 1e-8;   // of D's denominator and of k, as in DIR's code
inline constexpr double kFresnelSquare = -5.55473;  // F's exponent: VoH·(kFresnelSquare·VoH +
inline constexpr double kFresnelLinear = -6.98316;  // kFresnelLinear)
inline constexpr double kInversePi = 0.318309886183790671538;

}  // namespace glint
