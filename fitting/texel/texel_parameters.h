// The unbounded variables that the solver moves, and the physical values they stand for.
//
// A bounded value x in (low, high) is x = u within [low + tail, high − tail], and approaches its
// bound exponentially beyond: x = low + tail·exp((u − low)/tail − 1). The map is once continuously
// differentiable and the identity over nearly all of the range, so the bounds cost neither the
// steps of Gauss–Newton nor the meaning of a prior in physical units, and a value at its bound can
// leave it again (a sine's gradient vanishes there; a logistic curve bends everywhere).
#pragma once

#include "fitting/reflectance/svbrdf_maps.h"
#include "fitting/texel/texel_kernel.h"

namespace glint {

struct ValueBounds {
  double low = 0.0, high = 1.0;
  double tail = 0.02;  // width over which the value bends toward its bound
};

inline constexpr ValueBounds kAlbedoBounds{0.0, 1.0, 0.05};
inline constexpr ValueBounds kRoughnessBounds{0.03, 1.0, 0.10};
inline constexpr double kMostSlope = 11.43;  // 85° of tilt: starts beyond are drawn back to it

// Value for the variable `u`, and its derivative.
double BoundedValue(const ValueBounds& bounds, double u, double* derivative);
// The variable for `value`; values nearer to a bound than 1 % of the tail are moved there.
double UnboundedVariable(const ValueBounds& bounds, double value);

// Physical values of the variables and dx_i/du_i.
void ToTexelValues(const double variables[kTexelParameters], TexelValues* values,
                   TexelValues* derivatives);
void ToVariables(const TexelValues& values, double variables[kTexelParameters]);

// Values as the reflectance model takes them; T may carry derivatives.
template <class T>
TexelSvbrdf<T> TexelFromValues(const T values[kTexelParameters]) {
  using std::sqrt;
  const T slope_x = values[kSlopeX], slope_y = values[kSlopeY];
  const T length = T(1) / sqrt(T(1) + slope_x * slope_x + slope_y * slope_y);
  TexelSvbrdf<T> texel{{slope_x * length, slope_y * length, length}, {}, {}, values[kRough]};
  for (int c = 0; c < 3; ++c) {
    texel.diffuse[c] = values[DiffuseParameter(c)];
    texel.specular[c] = values[SpecularParameter(c)];
  }
  return texel;
}

// One texel out of the maps and back. Reading clamps to what the variables can express.
TexelValues ReadTexel(const SvbrdfMaps& maps, size_t texel);
void WriteTexel(const TexelValues& values, size_t texel, SvbrdfMaps* maps);

}  // namespace glint
