#include "base/photos/decode_count.h"

#include <atomic>

namespace glint {
namespace {

std::atomic<std::int64_t> photos_decoded_whole{0}, photos_decoded_reduced{0};

}  // namespace

DecodeCounts PhotosDecoded() { return {photos_decoded_whole, photos_decoded_reduced}; }

void CountDecodedPhoto() { ++photos_decoded_whole; }
void CountReducedPhoto() { ++photos_decoded_reduced; }

}  // namespace glint
