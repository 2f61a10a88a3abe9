// The transfer function of sRGB (IEC 61966-2-1), for float and double: 1 is white on both sides.
#pragma once

#include <algorithm>
#include <cmath>

namespace glint {

// Values above 1 continue the curve.
template <class T>
T SrgbFromLinear(T linear) {
  return linear <= T(0.0031308) ? T(12.92) * linear
                                : T(1.055) * std::pow(linear, T(1) / T(2.4)) - T(0.055);
}

template <class T>
T LinearFromSrgb(T encoded) {
  return encoded <= T(0.04045) ? encoded / T(12.92)
                               : std::pow((encoded + T(0.055)) / T(1.055), T(2.4));
}

// For pictures that end at black and white.
template <class T>
T ClampedSrgb(T linear) {
  return SrgbFromLinear(std::clamp(linear, T(0), T(1)));
}

}  // namespace glint
