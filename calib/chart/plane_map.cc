#include "calib/chart/plane_map.h"

#include <Eigen/LU>

namespace glint {

Eigen::Matrix3d MapOfFourPoints(const std::array<Eigen::Vector2d, 4>& from,
                                const std::array<Eigen::Vector2d, 4>& to) {
  Eigen::Matrix<double, 8, 8> equations = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 1> right;
  for (int i = 0; i < 4; ++i) {
    const Eigen::RowVector3d point = from[i].homogeneous().transpose();
    for (int axis = 0; axis < 2; ++axis) {
      const int row = 2 * i + axis;
      equations.block<1, 3>(row, 3 * axis) = point;
      equations.block<1, 2>(row, 6) = -to[i][axis] * from[i].transpose();
      right[row] = to[i][axis];
    }
  }
  const Eigen::Matrix<double, 8, 1> solved = equations.fullPivLu().solve(right);
  Eigen::Matrix3d map;
  map << solved[0], solved[1], solved[2], solved[3], solved[4], solved[5], solved[6], solved[7], 1;
  return map;
}

}  // namespace glint
