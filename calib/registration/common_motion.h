// What shifts of views have in common: an offset of all, and the parallax of a height.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace glint {

struct ViewShift {
  Eigen::Vector2d shift_mm{0, 0};
  Eigen::Vector2d per_height{0, 0};  // by which 1 mm of height shifts it
  double sd_mm = 1;
};

struct CommonMotion {
  Eigen::Vector2d offset_mm{0, 0};
  double height_mm = 0;

  Eigen::Vector2d Off_mm(const ViewShift& view) const {
    return view.shift_mm - offset_mm - height_mm * view.per_height;
  }
};

// That of as many views as possible: the most probable one under Cauchy's density of what is off,
// the height's being normal about 0. From the motion of every pair of views, of views next to each
// other where there are many. At least one view.
CommonMotion FindCommonMotion(const std::vector<ViewShift>& views, double height_sd_mm);

}  // namespace glint
