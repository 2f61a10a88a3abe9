// Quarter turns of photographs: EXIF orientation turns the picture, and one camera with it.
//
// A turn by 90° clockwise takes the stored picture (W × H) to the upright one (H × W): image points
// to (H − y, x), camera points to (−Y, X, Z). A phone that is held upright and across is one
// camera; its intrinsics are estimated for the stored picture and turned afterwards.
#pragma once

#include "base/camera/camera_model.h"
#include "base/camera/rigid3.h"

namespace glint {

// Clockwise quarter turns (0 … 3) that EXIF orientation 1 … 8 asks for; mirrored ones (2, 4, 5, 7),
// which no camera writes, are not turns: nullopt.
std::optional<int> QuarterTurns(int exif_orientation);

// The picture of size width × height is turned `turns` times; negative: anticlockwise.
Eigen::Vector2d TurnedImagePoint(Eigen::Vector2d point_px, int width_px, int height_px, int turns);
Eigen::Vector3d TurnedCameraPoint(Eigen::Vector3d point_in_camera, int turns);
Rigid3 TurnedPose(const Rigid3& camera_from_sample, int turns);
// ImageFromCamera(TurnedCamera(c, n), TurnedCameraPoint(p, n)) =
// TurnedImagePoint(ImageFromCamera(c, p))
Camera TurnedCamera(const Camera& camera, int turns);

}  // namespace glint
