// The cost function of one corner, with derivatives by Jets; apart from bundle_internal.h because
// Ceres is heavy.
#pragma once

#include <ceres/cost_function.h>

#include <memory>

#include "calib/bundle/reprojection.h"

namespace glint::bundle {

// Parameter blocks: camera (as many as the model has), pose (6); with `bend_is_free` also the
// bend's two heights.
std::unique_ptr<ceres::CostFunction> MakeCost(CameraModel model, const Eigen::Matrix3d& rotation0,
                                              const BundleCorner& corner, const BoardBend& bend,
                                              bool bend_is_free);

}  // namespace glint::bundle
