// By how much each view's texture is displaced against what the other views say of it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/registration/detail_pictures.h"

namespace glint {

// What all others place at point_mm of the sample is looked up at point_mm + shift_mm in this view.
struct PredictedShift {
  int view = 0;
  Eigen::Vector2d point_mm{0, 0}, shift_mm{0, 0};
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  // 1/mm², up to a common factor
};

// In overlapping windows of an eighth of the sample. A view's texture is predicted from the others'
// by the window's factors (factor_analysis.h), which know how shading moves with the light, and the
// displacement is one Gauss-Newton step from there. Empty with too few views. The same for any
// number of threads.
std::vector<PredictedShift> PredictedShifts(const DetailPictures& pictures,
                                            const SamplePlaces& places, const cv::Size& size,
                                            int threads);

}  // namespace glint
