#include "rectify/resample/filter_kernel.h"

#include <cmath>
#include <numbers>

namespace glint {
namespace {

double Cubic(double b, double c, double r) {
  if (r < 1) {
    return ((12 - 9 * b - 6 * c) * r * r * r + (-18 + 12 * b + 6 * c) * r * r + 6 - 2 * b) / 6;
  }
  if (r < 2) {
    return ((-b - 6 * c) * r * r * r + (6 * b + 30 * c) * r * r + (-12 * b - 48 * c) * r + 8 * b +
            24 * c) /
           6;
  }
  return 0;
}

constexpr double kJincZero1 = 1.2196698912665045;  // zeros of J1(πx)
constexpr double kJincZero3 = 3.2383154841662362;

double Jinc(double x) {
  if (x < 1e-6) return 1;
  const double t = std::numbers::pi * x;
  return 2 * std::cyl_bessel_j(1.0, t) / t;
}

double Value(FilterKind kind, double r) {
  switch (kind) {
    case FilterKind::kSharp:
      return Cubic(0.2620, 0.3690, r);
    case FilterKind::kSoft:
      return Cubic(0.3782, 0.3109, r);
    case FilterKind::kLanczos:
      return r < kJincZero3 ? Jinc(r) * Jinc(r * kJincZero1 / kJincZero3) : 0;
  }
  return 0;
}

}  // namespace

std::optional<FilterKind> FilterFromName(std::string_view name) {
  if (name == "sharp") return FilterKind::kSharp;
  if (name == "soft") return FilterKind::kSoft;
  if (name == "lanczos") return FilterKind::kLanczos;
  return std::nullopt;
}

FilterKernel::FilterKernel(FilterKind kind)
    : radius_(kind == FilterKind::kLanczos ? kJincZero3 : 2.0),
      steps_per_r2_(static_cast<float>(kSteps / (radius_ * radius_))),
      table_(kSteps + 1) {
  for (int i = 0; i < kSteps; ++i) {
    table_[i] =
        static_cast<float>(Value(kind, radius_ * std::sqrt(static_cast<double>(i) / kSteps)));
  }
  table_[kSteps] = 0;
}

}  // namespace glint
