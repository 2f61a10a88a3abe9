#include "fitting/latent/spread_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glint {
namespace {

Vec3d Unit(const Vec3d& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

Vec3d HalfVector(const View& view) {
  const Vec3d l = Unit(view.light_in_sample_mm), c = Unit(view.camera_in_sample_mm);
  return Unit({l[0] + c[0], l[1] + c[1], l[2] + c[2]});
}

double SquaredDistance(const Vec3d& a, const Vec3d& b) {
  double sum = 0;
  for (size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

}  // namespace

std::vector<RectifiedView> SpreadViews(const std::vector<RectifiedView>& views, size_t most) {
  if (views.size() <= most || most == 0) return views;
  std::vector<Vec3d> half;
  half.reserve(views.size());
  for (const RectifiedView& view : views) half.push_back(HalfVector(view.view));
  std::vector<double> apart(views.size(), std::numeric_limits<double>::infinity());
  std::vector<bool> taken(views.size(), false);
  const auto top = std::max_element(half.begin(), half.end(),
                                    [](const Vec3d& a, const Vec3d& b) { return a[2] < b[2]; });
  size_t next = static_cast<size_t>(top - half.begin());
  for (size_t count = 0; count < most; ++count) {
    taken[next] = true;
    for (size_t i = 0; i < views.size(); ++i) {
      apart[i] = std::min(apart[i], SquaredDistance(half[i], half[next]));
    }
    next = static_cast<size_t>(std::max_element(apart.begin(), apart.end()) - apart.begin());
  }
  std::vector<RectifiedView> chosen;
  for (size_t i = 0; i < views.size(); ++i) {
    if (taken[i]) chosen.push_back(views[i]);
  }
  return chosen;
}

}  // namespace glint
