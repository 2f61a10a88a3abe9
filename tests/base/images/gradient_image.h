// A picture whose samples all differ.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/images/image.h"

namespace glint::test {

// From 0 to nearly 1, in the order in which samples are stored.
inline Image Gradient(int width, int height, std::vector<std::string> channels) {
  Image image(width, height, std::move(channels));
  for (size_t i = 0; i < image.samples.size(); ++i) {
    image.samples[i] = static_cast<float>(i) / static_cast<float>(image.samples.size());
  }
  return image;
}

}  // namespace glint::test
