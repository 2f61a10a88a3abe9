#include "calib/moving_light/gloss_likeness.h"

#include <cmath>

namespace glint {

Eigen::MatrixXd GlossLikeness(const std::vector<Eigen::Vector3d>& lights_mm) {
  constexpr double kLength = 0.5;  // radians
  const auto n = static_cast<Eigen::Index>(lights_mm.size());
  Eigen::MatrixXd likeness(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d from = lights_mm[static_cast<size_t>(i)].normalized();
    for (Eigen::Index j = 0; j < n; ++j) {
      const double off = (from - lights_mm[static_cast<size_t>(j)].normalized()).norm() / kLength;
      likeness(i, j) = std::exp(-off * off / 2);
    }
  }
  return likeness;
}

}  // namespace glint
