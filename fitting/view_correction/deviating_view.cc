#include "fitting/view_correction/deviating_view.h"

#include <cmath>

#include "fitting/view_correction/flash_offset.h"

namespace glint {

View Deviating(const View& said, const DeviationValues& deviation) {
  const Vec3d& light = said.light_in_sample_mm;
  const double distance = std::hypot(light[0], light[1], light[2]);
  View view = WithFlashOffset(
      said, {distance * deviation[kLightAcrossX], distance * deviation[kLightAcrossY], 0});
  view.exposure *= std::exp(deviation[kLogExposure]);
  view.curve.toe += kToeUnit * deviation[kToe];
  view.curve.shoulder += deviation[kShoulder];
  return view;
}

}  // namespace glint
