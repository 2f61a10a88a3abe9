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
  for (const std::string& name : CameraParameterNames(model)) {
    const double value = name[0] == 'f' ? focal_px
                         : name == "cx" ? 0.5 * group.width_px
                         : name == "cy" ? 0.5 * group.height_px
                                        : 0;
    camera.parameters.push_back(value);
  }
  return camera;
}

}  // namespace glint
