// How far a calibration is from a synthetic capture's truth.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/camera/similarity3.h"
#include "base/formats/calibration.h"

namespace glint {

struct PhotoPoseError {
  std::string photo;
  double position_percent = 0;  // camera centre's error relative to its distance from the sample
  double rotation_deg = 0;
  double light_mm = 0;          // flash position's error in the sample frame
  double corner_rms_texel = 0;  // of the sample's corners, see below
};

struct CalibrationErrors {
  double focal_length_percent = 0;  // largest of fx and fy over cameras in use
  double principal_point_px = 0;    // likewise
  double largest_position_percent = 0, mean_position_percent = 0;
  double corner_rms_texel = 0;          // root mean square over photos and corners
  double largest_corner_rms_texel = 0;  // of the worst photo
  double light_power_percent = 0;       // largest channel; 0 unless the estimate says it is known
  int missing_photos = 0;               // in the truth, not in the estimate
  std::vector<PhotoPoseError> photos;
};

// A rectified corner's error: the true camera images a corner of the sample at a pixel; the
// estimated camera says where on the sample's plane that pixel lies; the distance between the two,
// in texels of a rectified image `texels_across` wide. Photos are matched by name. Throws UserError
// when they have none in common.
CalibrationErrors CompareCalibrations(const Calibration& truth, const Calibration& estimate,
                                      const Eigen::Vector2d& sample_size_mm,
                                      int texels_across = 1024);

// `estimate` moved so that its camera centres come as near to those of `truth` as a similarity can
// bring them: frame and scale of the estimate no longer count. Throws UserError where fewer than
// three photographs are in both, or the cameras stand in a line.
Calibration AlignCalibration(const Calibration& truth, const Calibration& estimate,
                             Similarity3* truth_from_estimate = nullptr);

}  // namespace glint
