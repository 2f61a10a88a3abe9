#include "calib/light/tone_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/colour/srgb.h"

namespace glint {
namespace {

// ln(stored) of x = ln L, and its slope.
std::pair<double, double> LogStored(const ToneCurve& tone, double x) {
  const double t1 = tone.t[0].value, t2 = tone.t[1].value, t3 = tone.t[2].value;
  return {x * (1 + t1 + x * (t2 + x * t3)), 1 + t1 + x * (2 * t2 + 3 * x * t3)};
}

// Its inverse, by Newton's method: the curve rises where photographs show paper.
double LogLinear(const ToneCurve& tone, double log_stored) {
  constexpr int kSteps = 60;
  double x = log_stored;
  for (int i = 0; i < kSteps; ++i) {
    const auto [value, slope] = LogStored(tone, x);
    x -= (value - log_stored) / std::max(0.3, slope);
  }
  return x;
}

}  // namespace

double SrgbForGamma22(double radiance) {
  return LinearFromSrgb(std::pow(std::max(0.0, radiance), 1 / 2.2));
}

double ToneCurve::ExponentAt(double radiance) const {
  return LogStored(*this, LogLinear(*this, std::log(radiance))).second;
}

double ToneCurve::Linear(double radiance) const {
  if (radiance <= 0) return 0;
  if (radiance < lowest) {
    return radiance / lowest * std::exp(LogLinear(*this, std::log(lowest)));
  }
  if (radiance <= highest) return std::exp(LogLinear(*this, std::log(radiance)));
  if (radiance >= 1 || highest >= 1) return radiance;
  const double top = std::exp(LogLinear(*this, std::log(highest)));
  return top + (1 - top) * (radiance - highest) / (1 - highest);
}

}  // namespace glint
