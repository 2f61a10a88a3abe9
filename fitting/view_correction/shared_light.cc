#include "fitting/view_correction/shared_light.h"

#include <cmath>

namespace glint {
namespace {

double LogDistance(const View& view, double distance_mm) {
  const Vec3d& light = view.light_in_sample_mm;
  return std::log(std::hypot(light[0], light[1], light[2]) / distance_mm);
}

}  // namespace

View WithSharedLight(const View& said, const SharedLight& shared) {
  View view = WithFlashOffset(said, shared.offset_mm);
  view.beam = {shared.shape[kBeamX], shared.shape[kBeamY]};
  view.exposure *= std::exp(shared.shape[kDistancePower] * LogDistance(said, shared.distance_mm));
  return view;
}

LightShapeValues ByLightShape(const View& view, double distance_mm, double x_mm, double y_mm) {
  const Vec3d& light = view.light_in_sample_mm;
  return {(x_mm - light[0]) / light[2], (y_mm - light[1]) / light[2],
          LogDistance(view, distance_mm)};
}

}  // namespace glint
