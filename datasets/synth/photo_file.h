// Photographs as a phone writes them.
#pragma once

#include <filesystem>
#include <vector>

namespace glint {

struct PhotoFacts {
  double focal_length_35mm = 0;  // 0: none written
  double focal_length_mm = 0;
  double exposure_time_s = 0, iso = 0, f_number = 0;
  int jpeg_quality = 95;
};

// 8-bit RGB, interleaved, as JPEG (4:2:0 as phones do, EXIF from `facts`) or PNG by the
// file's extension. No time stamp: identical inputs give identical bytes. Throws EnvironmentError.
void WritePhoto(const std::filesystem::path& file, int width, int height,
                const std::vector<unsigned char>& rgb, const PhotoFacts& facts);

}  // namespace glint
