#include "fitting/view_correction/flash_offset.h"

#include <Eigen/Geometry>

namespace glint {

View WithFlashOffset(View view, const FlashOffset& offset_mm) {
  const Vec3d light = view.light_in_sample_mm;
  // The least turn that takes z to the light's direction.
  const auto turn = Eigen::Quaterniond::FromTwoVectors(
      Eigen::Vector3d::UnitZ(), Eigen::Vector3d(light[0], light[1], light[2]));
  const Eigen::Vector3d offset = turn * Eigen::Vector3d(offset_mm[0], offset_mm[1], offset_mm[2]);
  for (size_t i = 0; i < 3; ++i) {
    view.light_in_sample_mm[i] += offset[static_cast<Eigen::Index>(i)];
  }
  return view;
}

}  // namespace glint
