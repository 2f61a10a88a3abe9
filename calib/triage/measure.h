// What is measured of each photograph, so that bad ones can be named. Cheap: most of it works on
// the reduced picture in which the board is looked for.
#pragma once

#include <string>
#include <vector>

#include "base/photos/photo.h"
#include "calib/corners/detector.h"
#include "calib/corners/gray_image.h"

namespace glint {

struct PhotoMeasures {
  std::string name;
  bool flash_photo = true;  // false: of the board alone
  Photo file;               // as ReadPhoto gives it, its samples taken out
  int corners = 0;
  // Width of the edges at the board's corners: the median blur σ of the saddle fits in the full
  // picture; 0: no corners.
  double blur_px = 0;
  // The same of the strong edges in the board's region (or the picture, without corners): nine in
  // ten are wider, so that what lies out of focus does not count. Along rows or along columns,
  // whichever is larger, since a shake blurs one direction; 0: too few edges.
  double edge_px = 0;
  double clipped = 0;    // share of the board's region (or the picture) with a channel at its end
  double white = 0;      // 99th percentile of the luma there, stored, 0 … 1
  double brightest = 0;  // of all samples, stored
  std::vector<unsigned char> thumbnail;  // 48×48, for duplicates
};

// `gray` is GrayFromPhoto(photo); the photo's samples stay where they are.
PhotoMeasures MeasurePhoto(const std::string& name, const Photo& photo, const GrayImage& gray,
                           const BoardDetection& detection);

}  // namespace glint
