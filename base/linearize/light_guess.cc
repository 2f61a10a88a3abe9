#include "base/linearize/light_guess.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

constexpr int kGrid = 64;
constexpr double kMedianAlbedo = 0.3;
constexpr double kBrightAlbedo = 0.95;

// At most kGrid of n positions, evenly spread.
std::vector<int> Spread(int n) {
  const int count = std::min(kGrid, n);
  std::vector<int> positions(count);
  for (int i = 0; i < count; ++i) {
    positions[i] = static_cast<int>((2 * static_cast<int64_t>(i) + 1) * n / (2 * count));
  }
  return positions;
}

// Irradiance on the texel at (x, y) of a light of power 1.
double UnitIrradiance(const View& view, LightFalloff falloff, double x_mm, double y_mm) {
  const double dx = view.light_in_sample_mm[0] - x_mm;
  const double dy = view.light_in_sample_mm[1] - y_mm;
  const double dz = view.light_in_sample_mm[2];
  const double d2 = dx * dx + dy * dy + dz * dz;
  const double cosine = dz / std::sqrt(d2);
  return falloff == LightFalloff::kInverseSquare ? cosine / d2 : cosine;
}

}  // namespace

LightGuess::LightGuess(const SamplePlane& plane, LightFalloff falloff)
    : plane_(plane),
      falloff_(falloff),
      columns_(Spread(plane.width)),
      rows_(Spread(plane.height)) {}

void LightGuess::Add(const RectifiedImage& image) {
  BeginView();
  AddRows(image);
}

void LightGuess::BeginView() {
  radiance_.emplace_back().reserve(points());
  next_row_ = 0;
}

void LightGuess::AddRows(const RectifiedImage& rows) {
  const size_t texels = static_cast<size_t>(rows.width) * static_cast<size_t>(rows.height);
  const int end = next_row_ + rows.height;
  for (const int row : rows_) {
    if (row < next_row_ || row >= end) continue;
    for (const int column : columns_) {
      const size_t i = static_cast<size_t>(row - next_row_) * static_cast<size_t>(rows.width) +
                       static_cast<size_t>(column);
      const float mean = (rows.rgb[i] + rows.rgb[texels + i] + rows.rgb[2 * texels + i]) / 3;
      radiance_.back().push_back(rows.mask[i] < 0.5f ? -1.0f : mean);
    }
  }
  next_row_ = end;
}

double LightGuess::Power(const std::vector<View>& views) const {
  std::vector<double> typical;
  for (size_t point = 0; point < points(); ++point) {
    const double x_mm = plane_.x_mm(columns_[point % columns_.size()]);
    const double y_mm = plane_.y_mm(rows_[point / columns_.size()]);
    std::vector<double> q;
    for (size_t v = 0; v < radiance_.size(); ++v) {
      if (radiance_[v][point] < 0) continue;
      const double irradiance = UnitIrradiance(views[v], falloff_, x_mm, y_mm) * views[v].exposure;
      if (irradiance > 0) q.push_back(std::numbers::pi * radiance_[v][point] / irradiance);
    }
    if (q.empty()) continue;
    std::sort(q.begin(), q.end());
    typical.push_back(q[(q.size() - 1) / 2]);
  }
  if (typical.empty()) return 0;
  std::sort(typical.begin(), typical.end());
  const double median = typical[typical.size() / 2];
  const double bright = typical[typical.size() * 95 / 100];
  return std::max(median / kMedianAlbedo, bright / kBrightAlbedo);
}

void GiveLight(const LightGuess& guess, RectifiedSet* set) {
  std::vector<View> views;
  for (const RectifiedView& view : set->views) views.push_back(view.view);
  const double power = guess.Power(views);
  if (!(power > 0)) return;
  for (RectifiedView& view : set->views) view.view.light_rgb = {power, power, power};
}

}  // namespace glint
