#include "calib/chart/chart_picture.h"

#include <algorithm>
#include <cmath>

#include "base/colour/srgb.h"
#include "calib/chart/cielab.h"

namespace glint {
namespace {

constexpr int kLongerSide_px = 720;
constexpr float kBackground = 0.1f;

// A square of the chart's plane.
void Fill(const Eigen::Vector2d& centre, double half, double px_per_unit,
          const Eigen::Vector3d& stored, Image* picture) {
  const Eigen::Vector2d least = px_per_unit * (centre.array() - half).matrix();
  const Eigen::Vector2d most = px_per_unit * (centre.array() + half).matrix();
  const auto pixel = [](double at, int end) {
    return std::clamp(static_cast<int>(std::lround(at)), 0, end);
  };
  for (int y = pixel(least.y(), picture->height); y < pixel(most.y(), picture->height); ++y) {
    for (int x = pixel(least.x(), picture->width); x < pixel(most.x(), picture->width); ++x) {
      for (int c = 0; c < 3; ++c) {
        picture->channel(c)[static_cast<size_t>(y) * picture->width + x] =
            static_cast<float>(stored[c]);
      }
    }
  }
}

Eigen::Vector3d StoredOf(const Eigen::Vector3d& lab) {
  return Rec709FromLab(lab).unaryExpr(&ClampedSrgb<double>);
}

}  // namespace

Image ChartPicture(const Chart& chart, const ChartSolution& solution) {
  const double px_per_unit = kLongerSide_px / chart.size.maxCoeff();
  Image picture(static_cast<int>(std::lround(px_per_unit * chart.size.x())),
                static_cast<int>(std::lround(px_per_unit * chart.size.y())), kRgbChannels);
  std::fill(picture.samples.begin(), picture.samples.end(), kBackground);
  for (const ChartPatch& patch : chart.patches) {
    Fill(patch.centre, patch.half_side, px_per_unit, StoredOf(patch.lab), &picture);
    Fill(patch.centre, 0.8 * patch.half_side, px_per_unit, Eigen::Vector3d::Constant(kBackground),
         &picture);
  }
  for (const PatchColour& seen : solution.patches) {
    const ChartPatch& patch = chart.patches[seen.patch];
    Fill(patch.centre, patch.half_side, px_per_unit, StoredOf(seen.lab), &picture);
    Fill(patch.centre, 0.5 * patch.half_side, px_per_unit, StoredOf(patch.lab), &picture);
  }
  return picture;
}

}  // namespace glint
