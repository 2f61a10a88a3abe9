#include "pipeline/export/metallic.h"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr double kSmall = 1e-6;

double PerceivedBrightness(const std::array<float, 3>& c) {
  return std::sqrt(0.299 * c[0] * c[0] + 0.587 * c[1] * c[1] + 0.114 * c[2] * c[2]);
}

// The blend m of  diffuse = base·(1 − F0)(1 − m)/(1 − s)  and  specular = F0 + m(base − F0).
double SolveMetallic(double diffuse, double specular, double one_minus_specular) {
  if (specular < kDielectricF0) return 0;
  const double a = kDielectricF0;
  const double b =
      diffuse * one_minus_specular / (1 - kDielectricF0) + specular - 2 * kDielectricF0;
  const double c = kDielectricF0 - specular;
  const double discriminant = std::max(b * b - 4 * a * c, 0.0);
  return std::clamp((-b + std::sqrt(discriminant)) / (2 * a), 0.0, 1.0);
}

}  // namespace

BaseColorMetallic ToBaseColorMetallic(const std::array<float, 3>& diffuse,
                                      const std::array<float, 3>& specular) {
  const double one_minus_specular =
      1 - std::clamp<double>(*std::max_element(specular.begin(), specular.end()), 0, 1);
  const double metallic = SolveMetallic(PerceivedBrightness(diffuse), PerceivedBrightness(specular),
                                        one_minus_specular);
  BaseColorMetallic result;
  result.metallic = static_cast<float>(metallic);
  for (size_t c = 0; c < 3; ++c) {
    const double from_diffuse =
        diffuse[c] * one_minus_specular / (1 - kDielectricF0) / std::max(1 - metallic, kSmall);
    const double from_specular =
        (specular[c] - kDielectricF0 * (1 - metallic)) / std::max(metallic, kSmall);
    const double blend = metallic * metallic;
    result.base_color[c] = static_cast<float>(
        std::clamp(from_diffuse + (from_specular - from_diffuse) * blend, 0.0, 1.0));
  }
  return result;
}

}  // namespace glint
