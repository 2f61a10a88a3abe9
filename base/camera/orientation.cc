#include "base/camera/orientation.h"

#include <utility>

namespace glint {
namespace {

int Modulo4(int turns) { return ((turns % 4) + 4) % 4; }

Camera OnceTurned(const Camera& camera) {
  Camera turned = camera;
  turned.width_px = camera.height_px;
  turned.height_px = camera.width_px;
  const size_t centre = PrincipalPointIndex(camera.model);
  if (centre == 2) std::swap(turned.parameters[0], turned.parameters[1]);
  turned.parameters[centre] = camera.height_px - camera.parameters[centre + 1];
  turned.parameters[centre + 1] = camera.parameters[centre];
  const auto& infos = InfoOf(camera.model).parameters;
  for (size_t i = centre + 2; i + 1 < camera.parameters.size(); ++i) {
    if (!infos[i].of_a_vector()) continue;
    const bool x_first = infos[i].kind == CameraParameter::kAlongX;
    const size_t x = x_first ? i : i + 1, y = x_first ? i + 1 : i;
    turned.parameters[x] = -camera.parameters[y];
    turned.parameters[y] = camera.parameters[x];
    ++i;
  }
  return turned;
}

}  // namespace

std::optional<int> QuarterTurns(int exif_orientation) {
  switch (exif_orientation) {
    case 1:
      return 0;
    case 6:
      return 1;
    case 3:
      return 2;
    case 8:
      return 3;
    default:
      return std::nullopt;
  }
}

Eigen::Vector2d TurnedImagePoint(Eigen::Vector2d point_px, int width_px, int height_px, int turns) {
  for (int i = Modulo4(turns); i > 0; --i) {
    point_px = Eigen::Vector2d(height_px - point_px.y(), point_px.x());
    std::swap(width_px, height_px);
  }
  return point_px;
}

Eigen::Vector3d TurnedCameraPoint(Eigen::Vector3d p, int turns) {
  for (int i = Modulo4(turns); i > 0; --i) p = Eigen::Vector3d(-p.y(), p.x(), p.z());
  return p;
}

Rigid3 TurnedPose(const Rigid3& camera_from_sample, int turns) {
  Rigid3 turned;
  for (int i = 0; i < 3; ++i) {
    turned.rotation.col(i) = TurnedCameraPoint(camera_from_sample.rotation.col(i), turns);
  }
  turned.translation = TurnedCameraPoint(camera_from_sample.translation, turns);
  return turned;
}

Camera TurnedCamera(const Camera& camera, int turns) {
  Camera turned = camera;
  for (int i = Modulo4(turns); i > 0; --i) turned = OnceTurned(turned);
  return turned;
}

}  // namespace glint
