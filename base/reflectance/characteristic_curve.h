// The characteristic curve of a camera (Hurter and Driffield 1890), relative to the one by which
// its photographs are read: what they record of a radiance, where 1 is the sensor's limit.
//
//   I = R · t(R) · s(R)
//
// The toe: phones crush the dark, which is read as too dark; stray light in the lens, or a black
// level that was not taken off, adds to it.
//   toe > 0:       t = R/(R + toe)      the radiance is R − toe where it is large beside it, 0 at 0
//   toe ≤ 0:       t = (R − toe)/R
// The shoulder: they also press the bright together.
//   shoulder > 0:  s = (1 + shoulder)/(1 + shoulder·R)
//   shoulder ≤ 0:  s = 1 + shoulder·(1 − R)
// One function of R ≥ 0 and both with continuous first derivatives, increasing in R for shoulder >
// −1 and R ≤ 1.
#pragma once

#include <span>

namespace glint {

struct CharacteristicCurve {
  double toe = 0, shoulder = 0;

  bool straight() const { return toe == 0 && shoulder == 0; }
  bool operator==(const CharacteristicCurve&) const = default;
};

// T: float, double or a vector of float; Scalar: its element.
template <class T>
struct RecordedRadiance {
  T value, slope;  // and its derivative by the radiance
};

template <class T, class Scalar>
inline RecordedRadiance<T> Recorded(const T& radiance, Scalar toe, Scalar shoulder) {
  RecordedRadiance<T> of{radiance - toe, T{} + Scalar(1)};
  if (toe > 0) {
    const T inverse = Scalar(1) / (radiance + toe);
    of.value = radiance * radiance * inverse;
    of.slope = (Scalar(1) - toe * inverse) * (Scalar(1) + toe * inverse);
  }
  if (shoulder > 0) {
    const T inverse = Scalar(1) / (Scalar(1) + shoulder * radiance);
    const T gain = (Scalar(1) + shoulder) * inverse;
    of.slope = gain * (of.slope - of.value * (shoulder * inverse));
    of.value = of.value * gain;
  } else if (shoulder < 0) {
    const T gain = Scalar(1) + shoulder * (Scalar(1) - radiance);
    of.slope = gain * of.slope - of.value * shoulder;
    of.value = of.value * gain;
  }
  return of;
}

// Radiances as they are recorded, in place. Below 0, where the harmonics of environment lighting
// may reach, they stay as they are.
inline void Record(const CharacteristicCurve& curve, std::span<float> radiances) {
  if (curve.straight()) return;
  const auto toe = static_cast<float>(curve.toe), shoulder = static_cast<float>(curve.shoulder);
  for (float& radiance : radiances) {
    if (radiance > 0) radiance = Recorded(radiance, toe, shoulder).value;
  }
}

}  // namespace glint
