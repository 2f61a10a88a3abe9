// The tone curve that the board's paper tells.
#pragma once

#include <array>

namespace glint {

// Radiance by sRGB's curve of what was read with gamma 2.2; 0 and 1 stay.
double SrgbForGamma22(double radiance);

// A value with its standard deviation; 0: held.
struct Estimate {
  double value = 0, sigma = 0;
};

// Radiance L is stored as if it were L^(1 + t1 + t2·x + t3·x²), x = ln L, see light_model.h.
struct ToneCurve {
  std::array<Estimate, 3> t;
  double lowest = 0, highest = 1;  // radiance, as read, that the paper showed

  double ExponentAt(double radiance) const;  // d ln stored/d ln L where `radiance` was read
  // L where `radiance` was read; outside what was seen the curve goes on with the exponent 1, as it
  // is read, toward black, and straight to (1, 1), where it clips.
  double Linear(double radiance) const;
};

}  // namespace glint
