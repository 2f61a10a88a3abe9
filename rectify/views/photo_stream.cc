#include "rectify/views/photo_stream.h"

#include <utility>

namespace glint {
namespace {

StreamedPhoto Read(const std::filesystem::path& file, const std::string& encoding_name,
                   const SaturationRule& saturation) {
  Photo photo = ReadPhoto(file);
  const bool ldr = !photo.is_float();
  const double exposure = photo.exposure();
  const Encoding encoding = ResolveEncoding(encoding_name, file, photo);
  return {LinearPhoto(std::move(photo), encoding, saturation), ldr, exposure};
}

}  // namespace

PhotoStream::PhotoStream(std::vector<std::filesystem::path> files, std::string encoding,
                         SaturationRule saturation, bool read_ahead)
    : files_(std::move(files)),
      encoding_(std::move(encoding)),
      saturation_(saturation),
      read_ahead_(read_ahead) {}

std::future<StreamedPhoto> PhotoStream::Start(size_t index) const {
  const auto policy = read_ahead_ ? std::launch::async : std::launch::deferred;
  return std::async(policy, Read, files_[index], encoding_, saturation_);
}

StreamedPhoto PhotoStream::Next() {
  std::future<StreamedPhoto> now = ahead_.valid() ? std::move(ahead_) : Start(next_);
  ++next_;
  StreamedPhoto photo = now.get();
  if (read_ahead_ && next_ < files_.size()) ahead_ = Start(next_);
  return photo;
}

}  // namespace glint
