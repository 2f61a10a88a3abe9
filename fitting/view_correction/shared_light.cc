#include "fitting/view_correction/shared_light.h"

#include <cmath>

#include "fitting/view_correction/flash_offset.h"

namespace glint {
namespace {

double Distance_mm(const View& view) {
  const Vec3d& light = view.light_in_sample_mm;
  return std::hypot(light[0], light[1], light[2]);
}

}  // namespace

double MeanLightDistance_mm(std::span<const View> views) {
  double sum = 0;
  for (const View& view : views) sum += Distance_mm(view);
  return sum / static_cast<double>(views.size());
}

View WithSharedLight(const View& said, const SharedLight& shared) {
  const SharedLightValues& values = shared.values;
  View view = WithFlashOffset(
      said, {values[kOffsetX] * shared.distance_mm, values[kOffsetY] * shared.distance_mm, 0});
  view.beam = {values[kBeamX], values[kBeamY]};
  view.curve = {kToeUnit * values[kSharedToe], values[kSharedShoulder]};
  view.exposure *= std::pow(Distance_mm(said) / shared.distance_mm, values[kDistancePower]);
  return view;
}

SharedLightValues DeviationsByShared(const View& view, double distance_mm, double x_mm,
                                     double y_mm) {
  const Vec3d& light = view.light_in_sample_mm;
  const double own_distance_mm = Distance_mm(view);
  SharedLightValues by{};
  by[kOffsetX] = by[kOffsetY] = distance_mm / own_distance_mm;
  by[kBeamX] = (x_mm - light[0]) / light[2];
  by[kBeamY] = (y_mm - light[1]) / light[2];
  by[kDistancePower] = std::log(own_distance_mm / distance_mm);
  by[kSharedToe] = by[kSharedShoulder] = 1;
  return by;
}

}  // namespace glint
