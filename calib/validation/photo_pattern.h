// What the residuals of one photograph say about how it was taken.
//
// Rolling shutter or a phone that moves while the rows are read: the pose changes by a small motion
// m from the first row to the last, so that a corner at row y is off by J m (y − H/2)/H, with J the
// image's derivative by the pose. m is fitted to the residuals, beside the pose itself; its effect
// must stand out by an F-test, and the same fit with columns, which no shutter follows, must not
// explain more. A wrong model of the lens looks alike, but in most photographs (see diagnosis.cc).
// A blur by motion scatters corners along one direction: the axes of the residuals' covariance.
#pragma once

#include <Eigen/Core>
#include <string>

#include "calib/bundle/bundle.h"

namespace glint {

struct PhotoPattern {
  double rms_px = 0;
  double mean_length_px = 0;         // root mean square along the axis of the largest scatter …
  double across_px = 0;              // … and across it
  double axis_deg = 0;               // of that axis in the image, from x toward y, in [0, 180)
  double row_motion_px = 0;          // RMS effect of the fitted motion
  double row_motion_share = 0;       // of the residuals' squares that it explains, in [0, 1]
  double row_motion_f = 0;           // F of that fit: six unknowns
  double column_motion_share = 0;    // the same for columns
  bool moved_while_read = false;     // rolling shutter, or phone or board moved
  bool scattered_on_a_line = false;  // a motion blur
};

// `photo` is an index into result.photos, of an accepted photo. `usual_length_px` is the median of
// mean_length_px over the photos (0: unknown, and scattered_on_a_line stays false).
PhotoPattern PatternOf(const BundleResult& result, size_t photo, double usual_length_px = 0);

}  // namespace glint
