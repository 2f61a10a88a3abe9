// The picture corners are looked for in: 8 bits, as the eye would see it.
#pragma once

#include <vector>

#include "base/photos/photo.h"

namespace glint {

struct GrayImage {
  int width = 0, height = 0;
  std::vector<unsigned char> samples;  // rows top to bottom

  unsigned char at(int column, int row) const {
    return samples[static_cast<size_t>(row) * width + column];
  }
};

// Luma of a photo. Float photos (EXR, RAW) are scaled so that their 99th percentile is white, and
// gamma-encoded: edges in dark parts are then as steep as in bright ones.
GrayImage GrayFromPhoto(const Photo& photo);

// The image reduced by the whole factor that brings its longer side to at most `longest_px`
// (box average); `factor` returns it, 1 when the image is small enough already.
GrayImage Reduced(const GrayImage& image, int longest_px, int* factor);

}  // namespace glint
