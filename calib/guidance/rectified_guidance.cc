#include "calib/guidance/rectified_guidance.h"

namespace glint {

Verdict JudgeRectifiedSet(const RectifiedSet& set) {
  GuidanceInput input;
  input.sample_size_mm = {set.plane.width_mm, set.plane.height_mm};
  input.resolution_px = {set.plane.width, set.plane.height};
  for (const RectifiedView& view : set.views) {
    GuidancePhoto photo;
    photo.name = view.photo.empty() ? view.name : view.photo;
    photo.camera_in_sample_mm = Eigen::Vector3d(view.view.camera_in_sample_mm.data());
    photo.light_in_sample_mm = Eigen::Vector3d(view.view.light_in_sample_mm.data());
    input.photos.push_back(photo);
  }
  input.fixed_camera = set.fixed_camera;
  return Judge(input);
}

}  // namespace glint
