// Frames of videos, through FFmpeg's libraries.
//
// Frames are counted in the order of showing, whatever the frame rate does, by the time stamps of
// the packets: that list is read without decoding. A frame is then decoded from the key frame
// before it, so that any frame costs about the same.
#pragma once

#include <filesystem>
#include <utility>

#include "base/photos/photo.h"

namespace glint {

struct VideoInfo {
  int frames = 0;             // that are there whole
  int missing = 0;            // that the container tells of besides: the file is cut off
  int width = 0, height = 0;  // upright
};

// Throws UserError: missing, no video, cut off before the first frame, HDR (whose values are no
// 8-bit photograph's).
VideoInfo ReadVideoInfo(const std::filesystem::path& file);

// One frame as a photograph of 8 bits, upright, by the video's own matrix and range; `orientation`
// as its container turns it. There is no EXIF. Throws UserError as ReadVideoInfo, and for a frame
// that is not there or damaged.
Photo ReadVideoFrame(const std::filesystem::path& file, int frame);

// Upright width and height.
std::pair<int, int> VideoFrameSize(const std::filesystem::path& file);

}  // namespace glint
