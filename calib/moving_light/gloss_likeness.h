// How alike what gloss adds is under two lights.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace glint {

// By pairs of lights (positions about the sample's centre): 1 on the diagonal, falling with the
// angle between them over 29°, the width of the lobe of a roughness of 0.5. What a tilt of the
// sample feigns is as smooth.
Eigen::MatrixXd GlossLikeness(const std::vector<Eigen::Vector3d>& lights_mm);

}  // namespace glint
