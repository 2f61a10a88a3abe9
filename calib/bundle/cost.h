// The cost function of one corner; apart from bundle_internal.h because Ceres is heavy.
#pragma once

#include <ceres/cost_function.h>

#include <memory>

#include "calib/bundle/reprojection.h"

namespace glint::bundle {

// Parameter blocks: camera (as many as the model has), pose (6).
std::unique_ptr<ceres::CostFunction> MakeCost(CameraModel model, const Eigen::Matrix3d& rotation0,
                                              const BundleCorner& corner);

}  // namespace glint::bundle
