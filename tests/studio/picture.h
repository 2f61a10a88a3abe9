// Small pictures, one for each seed.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace glint::test {

inline std::string JpegBytes(int seed, int width = 320, int height = 240) {
  cv::Mat picture(height, width, CV_8UC3);
  cv::RNG random(static_cast<std::uint64_t>(seed) + 1);
  random.fill(picture, cv::RNG::UNIFORM, 40, 200);
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes);
  return {bytes.begin(), bytes.end()};
}

inline std::string PngBytes(int seed) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", cv::Mat(48, 64, CV_8UC3, cv::Scalar(seed, 90, 200)), bytes);
  return {bytes.begin(), bytes.end()};
}

}  // namespace glint::test
