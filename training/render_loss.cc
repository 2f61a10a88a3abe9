#include "training/render_loss.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

Vec3d CosineDirection(Stream* random) {
  const double u = random->Uniform(0.0, 0.97), angle = random->Uniform(0.0, 2.0 * std::numbers::pi);
  const double r = std::sqrt(u);
  return {r * std::cos(angle), r * std::sin(angle), std::sqrt(1.0 - u)};
}

double Distance(Stream* random) {
  return std::clamp(std::exp(0.5 + 0.75 * random->Normal()), 0.7, 8.0);
}

Vec3d Along(const Vec3d& from, const Vec3d& direction, double distance) {
  return {from[0] + distance * direction[0], from[1] + distance * direction[1],
          from[2] + distance * direction[2]};
}

}  // namespace

std::vector<View> DrawRenderLossViews(Stream* random, int count) {
  std::vector<View> views;
  const int free_views = (count + 2) / 3;
  for (int i = 0; i < count; ++i) {
    const bool mirror = i >= free_views;
    const Vec3d centre =
        mirror ? Vec3d{random->Uniform(-1, 1), random->Uniform(-1, 1), 0.0} : Vec3d{0.0, 0.0, 0.0};
    const Vec3d to_light = CosineDirection(random);
    const Vec3d to_camera =
        mirror ? Vec3d{-to_light[0], -to_light[1], to_light[2]} : CosineDirection(random);
    View view;
    view.light_in_sample_mm = Along(centre, to_light, Distance(random));
    view.camera_in_sample_mm = Along(centre, to_camera, Distance(random));
    view.light_rgb = {std::numbers::pi, std::numbers::pi, std::numbers::pi};
    views.push_back(view);
  }
  return views;
}

}  // namespace glint
