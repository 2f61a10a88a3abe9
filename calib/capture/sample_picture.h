// What is kept of a photograph to find the sample's plane in: the part that shows the sample, small
// and grey.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "base/linearize/encoding.h"
#include "base/photos/photo.h"
#include "calib/corners/detector.h"

namespace glint {

// The sample is looked for this many times as large as it is: where it lies higher than its frame
// it looks larger.
inline constexpr double kSampleMargin = 1.2;

// The root of the radiance, of which 65535 is 1: half a megapixel at most, in one megabyte.
struct SamplePicture {
  int width = 0, height = 0;       // 0: none
  double left_px = 0, top_px = 0;  // of it in the upright photograph
  double scale = 1;                // its pixels by the photograph's
  std::vector<std::uint16_t> values;
};

// `corners` tell where the sample is; without them it may be anywhere. `centres_mm`: where its
// centre may lie; more than the origin where a board that looks the same upside down may be turned.
// Empty where the photograph does not show the sample.
SamplePicture SamplePictureOf(const Photo& photo, const Encoding& encoding,
                              const std::vector<CornerObservation>& corners,
                              const std::array<double, 2>& sample_size_mm,
                              const std::vector<Eigen::Vector2d>& centres_mm = {{0, 0}});

}  // namespace glint
