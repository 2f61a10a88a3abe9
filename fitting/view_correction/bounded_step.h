// A Newton step within bounds.
#pragma once

#include <Eigen/Core>

namespace glint {

// The s in [least, most], of n values, that minimises ½·sᵀAs − gᵀs, A (n × n) symmetric and
// positive definite, by active sets (Nocedal and Wright, "Numerical Optimization", 2006, chapter
// 16). least ≤ most. To clamp the free solution A⁻¹g instead is wrong where values make up for each
// other: those that are not stopped would move as if the others had.
Eigen::VectorXd StepWithin(const Eigen::MatrixXd& a, const Eigen::VectorXd& g,
                           const Eigen::VectorXd& least, const Eigen::VectorXd& most);

}  // namespace glint
