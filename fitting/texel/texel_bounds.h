// The bounds of a texel's values, and the unbounded variables that stand for them.
//
// A bounded value x in (low, high) is x = u within [low + tail, high − tail], and approaches its
// bound exponentially beyond: x = low + tail·exp((u − low)/tail − 1). The map is once continuously
// differentiable and the identity over nearly all of the range, so the bounds cost neither the
// steps of Gauss–Newton nor the meaning of a prior in physical units, and a value at its bound can
// leave it again (a sine's gradient vanishes there; a logistic curve bends everywhere).
//
// Constants alone: the vector kernels include this (base/cpu/vectors.inl).
#pragma once

#include "base/model/solver.h"

namespace glint {

struct ValueBounds {
  double low = 0.0, high = 1.0;
  double tail = 0.02;  // width over which the value bends toward its bound
};

inline constexpr ValueBounds kAlbedoBounds{0.0, 1.0, constants::kAlbedoTail};
inline constexpr ValueBounds kRoughnessBounds{constants::kLeastRoughness, 1.0,
                                              constants::kRoughnessTail};
using constants::kMostSlope;  // initial normals beyond are drawn back to it

// Beyond this many tails the value is its bound to double precision.
using constants::kFarthestTail;
// In tails: values nearer to a bound are moved there before they become variables.
using constants::kNearestToBound;

}  // namespace glint
