// The motion of the camera's frame that goes with a change of its intrinsics.
//
// A shifted principal point is almost a turned camera: the bundle adjustment turns all poses along,
// and the board is seen as before. Intrinsics must therefore not be compared, nor their
// uncertainty propagated, in a camera frame that is thought to stay; mrcal's documentation
// ("Projection uncertainty", "Differencing") explains why and calls the motion "implied
// transformation". Here it is the rigid motion under which the points that the camera saw stay
// where they were in the image, in the least-squares sense.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/bundle/bundle.h"

namespace glint {

// Inlier corners of the camera's accepted photos, in its frame (mm).
std::vector<Eigen::Vector3d> SeenPoints(const BundleResult& result, int camera);

// The motion (rotation vector, shift in mm; 6 × parameters) implied by small changes of the
// camera's parameters.
Eigen::MatrixXd ImpliedMotion(const Camera& camera, const std::vector<Eigen::Vector3d>& points);

// to_from_from, by Gauss-Newton on Σ ‖π_to(to_from_from · p) − π_from(p)‖².
Rigid3 AlignCameras(const Camera& from, const Camera& to,
                    const std::vector<Eigen::Vector3d>& points_in_from);

}  // namespace glint
