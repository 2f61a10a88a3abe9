// Photographs read one ahead of their use, so that decoding and resampling overlap.
#pragma once

#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include "base/linearize/linear_photo.h"

namespace glint {

struct StreamedPhoto {
  LinearPhoto photo;
  bool ldr;         // 8 or 16 bit
  double exposure;  // time · ISO / f-number² by EXIF; 0: not known
};

class PhotoStream {
 public:
  // At most two photographs are in memory: the one handed out and, with `read_ahead`, the next.
  PhotoStream(std::vector<std::filesystem::path> files, std::string encoding,
              SaturationRule saturation, bool read_ahead);

  // The next photograph, in order. Throws what reading it threw. Not to be called at the end.
  StreamedPhoto Next();

 private:
  std::future<StreamedPhoto> Start(size_t index) const;

  std::vector<std::filesystem::path> files_;
  std::string encoding_;
  SaturationRule saturation_;
  bool read_ahead_;
  size_t next_ = 0;
  std::future<StreamedPhoto> ahead_;
};

}  // namespace glint
