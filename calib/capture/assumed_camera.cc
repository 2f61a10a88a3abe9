#include "calib/capture/assumed_camera.h"

#include <cmath>

namespace glint {
namespace {

constexpr double kPhoneFocal_mm = 26;  // 35 mm equivalent

}  // namespace

Camera AssumedCamera(const std::vector<DetectedPhoto>& photos, const CameraGroup& group,
                     CameraModel model) {
  const double reported_px = ReportedFocal_px(photos, group);
  const double focal_px = reported_px > 0 ? reported_px
                                          : kPhoneFocal_mm / kFilmDiagonal_mm *
                                                std::hypot(group.width_px, group.height_px);
  Camera camera{model, group.width_px, group.height_px, {}};
  camera.parameters.assign(CameraParameterNames(model).size(), 0.0);
  std::fill_n(camera.parameters.begin(), FocalLengthCount(model), focal_px);
  camera.parameters[PrincipalPointIndex(model)] = 0.5 * group.width_px;
  camera.parameters[PrincipalPointIndex(model) + 1] = 0.5 * group.height_px;
  return camera;
}

}  // namespace glint
