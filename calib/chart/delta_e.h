// CIEDE2000: how different two colours look (CIE 142:2001; G. Sharma, W. Wu, E. Dalal 2005, The
// CIEDE2000 Color-Difference Formula). About 1 is a difference that is just seen side by side.
#pragma once

#include <Eigen/Core>

namespace glint {

// The difference of two colours L*, a*, b*; kL = kC = kH = 1.
double DeltaE00(const Eigen::Vector3d& lab_1, const Eigen::Vector3d& lab_2);

// W with |W·(lab − reference)| close to DeltaE00(lab, reference) for small differences: the
// formula's terms at the reference (the change of its a* correction with chroma left out).
Eigen::Matrix3d DeltaE00Metric(const Eigen::Vector3d& reference);

}  // namespace glint
