// How much of a sample a photograph shows clipped.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "base/photos/photo.h"
#include "calib/corners/detector.h"

namespace glint {

// Share of a regular set of points of the sample, those inside of the photograph, whose pixel has a
// channel at the top of its range. Points are placed by one homography through the corners: lens
// distortion moves them by less than matters here. 0: floats, which never clip, or nothing to go
// by.
double ClippedShareOfSample(const Photo& photo, const std::vector<CornerObservation>& corners,
                            const std::array<double, 2>& sample_size_mm);

}  // namespace glint
