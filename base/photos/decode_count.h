// How many photographs this process has decoded: run.json tells it of every stage.
#pragma once

#include <cstdint>

namespace glint {

struct DecodeCounts {
  std::int64_t whole = 0;    // by ReadPhoto, a video's frames among them
  std::int64_t reduced = 0;  // JPEG, decoded at a half, a quarter or an eighth of its size
};

DecodeCounts PhotosDecoded();

// Once for each photograph whose pixels have been decoded; from any thread.
void CountDecodedPhoto();
void CountReducedPhoto();

}  // namespace glint
