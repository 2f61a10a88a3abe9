// Between Eigen's vectors, of poses, and the renderer's.
#pragma once

#include <Eigen/Core>

#include "base/reflectance/view.h"

namespace glint {

inline Vec3d ToVec3d(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace glint
