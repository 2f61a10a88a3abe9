// The projection's uncertainty as a picture.
#pragma once

#include <string>
#include <vector>

#include "base/images/image.h"
#include "calib/uncertainty/projection_uncertainty.h"

namespace glint {

// Values on a grid as colours (dark blue: 0, yellow: the largest shown) with lines of equal value
// and their figures, over the camera's image plane; white dots are `dots_px`, places where corners
// were seen. NaN is grey. Values above four times the median are shown as that.
Image MapPicture(const Camera& camera, const ImageGrid& grid, const std::vector<double>& values_px,
                 const std::vector<Eigen::Vector2d>& dots_px, const std::string& text,
                 int width_px = 1000);

Image UncertaintyPicture(const BundleResult& result, int camera, const UncertaintyMap& map);

// Inlier corners of a camera's accepted photos, in the image.
std::vector<Eigen::Vector2d> SeenCorners(const BundleResult& result, int camera);

}  // namespace glint
