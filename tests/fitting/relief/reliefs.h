// Reliefs with known height: what people photograph, as formulas.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace glint::test {

struct Relief {
  std::string name;
  std::function<double(double x, double y)> height_mm;  // over x, y in [−1, 1]
};

// A step from 0 to 1 around t = 0, `width` wide.
inline double SmoothStep(double t, double width) { return 0.5 + 0.5 * std::tanh(2 * t / width); }

// Stretcher bond: bricks .5 × .25 with joints between them.
inline double Bricks(double x, double y) {
  const double row = std::floor(4 * y);
  const double across = 2 * x + 0.5 * std::fmod(std::abs(row), 2);
  const double u = std::abs(across - std::round(across)) / 2;  // to the joint on either side
  const double v = std::abs(4 * y - std::round(4 * y)) / 4;
  const auto groove = [](double t) { return 1 - std::exp(-t * t / 0.0025); };  // 0 in the joint
  return 0.03 * groove(u) * groove(v);
}

// Plain weave of threads .2 apart.
inline double Weave(double x, double y) {
  const double u = 5 * M_PI * x, v = 5 * M_PI * y;
  return 0.015 * (std::sin(u) * std::sin(v) + 0.5 * std::cos(2 * u) * std::cos(2 * v));
}

// Dents of a hammer, on a jittered grid.
inline double Hammered(double x, double y) {
  double height = 0;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      const double cx = 0.3 * i + 0.07 * std::sin(13.0 * i + 7.0 * j);
      const double cy = 0.3 * j + 0.07 * std::cos(5.0 * i + 11.0 * j);
      height -= 0.04 * std::exp(-((x - cx) * (x - cx) + (y - cy) * (y - cy)) / 0.02);
    }
  }
  return height;
}

// Waves of falling size in turning directions.
inline double Grain(double x, double y) {
  double height = 0, size = 0.03, frequency = 3;
  for (int octave = 0; octave < 4; ++octave) {
    const double turn = 1.1 * octave;
    const double u = std::cos(turn) * x + std::sin(turn) * y;
    const double v = std::cos(turn) * y - std::sin(turn) * x;
    height += size * std::sin(frequency * u + 2 * std::sin(0.7 * frequency * v)) *
              std::cos(0.8 * frequency * v + octave);
    size *= 0.5;
    frequency *= 2;
  }
  return height;
}

// A round coin with a raised rim and a domed middle.
inline double Coin(double x, double y) {
  const double radius = std::hypot(x, y);
  return 0.05 * SmoothStep(0.8 - radius, 0.12) - 0.025 * SmoothStep(0.62 - radius, 0.12) +
         0.04 * std::exp(-radius * radius / 0.06);
}

inline std::vector<Relief> Reliefs() {
  return {{"bricks", Bricks},
          {"weave", Weave},
          {"hammered", Hammered},
          {"grain", Grain},
          {"coin", Coin}};
}

}  // namespace glint::test
