#include "calib/capture/reduced_photo.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/photos/decode_count.h"
#include "base/photos/jpeg_end.h"
#include "base/photos/photo_header.h"

namespace glint {
namespace {

constexpr std::size_t kMaxJpegBytes = 512u << 20;

int Reduction(int longest, int longest_px) {
  int reduction = 1;
  while (reduction < 8 && longest > longest_px * reduction) reduction *= 2;
  return reduction;
}

cv::Mat Decode(const std::filesystem::path& file, int reduction) {
  const std::string bytes = ReadTextFile(file, kMaxJpegBytes);
  if (!JpegIsComplete(bytes)) {
    throw UserError(file, "", "a truncated JPEG file, which ends before its image is complete",
                    "copy the photograph again, or remove it");
  }
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  const int flag = reduction == 2   ? cv::IMREAD_REDUCED_COLOR_2
                   : reduction == 4 ? cv::IMREAD_REDUCED_COLOR_4
                                    : cv::IMREAD_REDUCED_COLOR_8;
  cv::Mat picture;
  try {
    picture = cv::imdecode(raw, flag | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    picture = cv::Mat();
  }
  if (picture.empty()) {
    throw UserError(file, "", "a JPEG file that cannot be decoded",
                    "copy the photograph again, or remove it");
  }
  CountReducedPhoto();
  return picture;
}

// EXIF orientation 1 … 8 applied.
cv::Mat Upright(cv::Mat picture, int orientation) {
  const bool transposed = orientation >= 5;
  if (transposed) cv::transpose(picture, picture);
  // What is left after the transposition: 5 nothing, 6 across, 7 both, 8 down.
  const int flips[] = {-1, 0, 1, 3, 2, 0, 1, 3, 2};  // 1: across, 2: down, 3: both
  const int flip = flips[std::clamp(orientation, 1, 8)];
  if (flip == 1) cv::flip(picture, picture, 1);
  if (flip == 2) cv::flip(picture, picture, 0);
  if (flip == 3) cv::flip(picture, picture, -1);
  return picture;
}

}  // namespace

Photo ReadReducedPhoto(const std::filesystem::path& file, int longest_px, int* reduction) {
  PhotoHeader header = ReadPhotoHeader(file);
  *reduction = Reduction(std::max(header.stored_width, header.stored_height), longest_px);
  if (!header.is_jpeg || *reduction == 1) {
    *reduction = 1;
    return ReadPhoto(file);
  }
  const cv::Mat picture = Upright(Decode(file, *reduction), header.photo.orientation);
  Photo photo = header.photo;
  cv::Mat rgb;
  cv::cvtColor(picture, rgb, cv::COLOR_BGR2RGB);
  photo.image =
      StoredImage(rgb.cols, rgb.rows, std::vector<std::uint8_t>(rgb.datastart, rgb.dataend));
  return photo;
}

}  // namespace glint
