// Small branch-free curves that vectorise inside row loops.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glint::procedural {

inline constexpr float kPi = 3.14159265358979f;

inline float Clamp01(float x) { return std::min(std::max(x, 0.0f), 1.0f); }
inline float Mix(float a, float b, float t) { return a + (b - a) * t; }

// Floor as an integer, |x| < 2^31, without a library call.
inline int32_t FloorInt(float x) {
  const int32_t i = static_cast<int32_t>(x);
  return i - static_cast<int32_t>(x < static_cast<float>(i));
}
inline float Fract(float x) { return x - static_cast<float>(FloorInt(x)); }

// 0 at or below `low`, 1 at or above `high`, cubic between; low < high.
inline float SmoothStep(float low, float high, float x) {
  const float t = Clamp01((x - low) / (high - low));
  return t * t * (3.0f - 2.0f * t);
}
inline float Smooth(float t) { return t * t * (3.0f - 2.0f * t); }

// sin(2πt) to 1.1e-3, a parabola with one correction step.
inline float SinTurn(float t) {
  const float u = t - static_cast<float>(FloorInt(t + 0.5f));  // [-0.5, 0.5)
  const float y = 8.0f * u - 16.0f * u * std::fabs(u);
  return 0.225f * (y * std::fabs(y) - y) + y;
}
inline float CosTurn(float t) { return SinTurn(t + 0.25f); }

// Cross-section of a round thread: 1 at 0, 0 at |x| ≥ 1.
inline float Round(float x) { return std::sqrt(std::max(1.0f - x * x, 0.0f)); }

}  // namespace glint::procedural
