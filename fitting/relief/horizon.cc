#include "fitting/relief/horizon.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace glint {
namespace {

constexpr double kNearError = 0.05, kFarError = 0.02;  // of σ_k above
constexpr double kSurelyLit = 4;                       // standard deviations below the ray: 3e-5

double HeightError_texel(double distance_texel) {
  return std::sqrt(kNearError * kNearError * distance_texel +
                   kFarError * kFarError * distance_texel * distance_texel);
}

double SlopeVariance(const HeightField& field) {
  double squares = 0, count = 0;
  for (int row = 0; row < field.height; ++row) {
    for (int column = 0; column < field.width; ++column) {
      const double here = field.at(row, column);
      if (column > 0) {
        squares += std::pow((here - field.at(row, column - 1)) / field.texel_x_mm, 2);
        ++count;
      }
      if (row > 0) {
        squares += std::pow((here - field.at(row - 1, column)) / field.texel_y_mm, 2);
        ++count;
      }
    }
  }
  return count > 0 ? squares / count : 0;
}

}  // namespace

Horizon::Horizon(HeightField field, const SamplePlane& plane)
    : field_(std::move(field)),
      left_mm_(plane.x_mm(0)),
      top_mm_(plane.y_mm(0)),
      highest_mm_(*std::max_element(field_.height_mm.begin(), field_.height_mm.end())),
      slope_variance_(SlopeVariance(field_)) {}

double Horizon::HiddenShare(double x_mm, double y_mm, const Vec3d& light_in_sample_mm) const {
  const double to_x = light_in_sample_mm[0] - x_mm, to_y = light_in_sample_mm[1] - y_mm;
  const double across_mm = std::hypot(to_x, to_y);
  const double step_mm = std::min(field_.texel_x_mm, field_.texel_y_mm);
  if (!(across_mm > 0) || !(step_mm > 0)) return 0;
  const double rise_mm = step_mm * light_in_sample_mm[2] / across_mm;  // of the ray, a step
  const double columns = step_mm * to_x / across_mm / field_.texel_x_mm;
  const double rows = -step_mm * to_y / across_mm / field_.texel_y_mm;
  const double column = (x_mm - left_mm_) / field_.texel_x_mm;
  const double row = (top_mm_ - y_mm) / field_.texel_y_mm;
  const double here_mm = field_.Lookup(row, column);
  double nearest = -kSurelyLit;  // above the ray, in standard deviations
  for (int k = 1;; ++k) {
    const double error_mm = HeightError_texel(k) * step_mm, ray_mm = here_mm + k * rise_mm;
    if (highest_mm_ < ray_mm + nearest * error_mm) break;
    const double at_row = row + k * rows, at_column = column + k * columns;
    if (at_row < -0.5 || at_row > field_.height - 0.5) break;
    if (at_column < -0.5 || at_column > field_.width - 0.5) break;
    nearest = std::max(nearest, (field_.Lookup(at_row, at_column) - ray_mm) / error_mm);
  }
  return nearest > -kSurelyLit ? std::erfc(-nearest / std::numbers::sqrt2) / 2 : 0;
}

}  // namespace glint
