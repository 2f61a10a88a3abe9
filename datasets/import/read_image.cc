#include "datasets/import/read_image.h"

#include <fmt/format.h>

#include <utility>

#include "base/errors/errors.h"

namespace glint {

PixelSize SampleSize(const ForeignSet& set) {
  const std::filesystem::path& first = set.views[0].image;
  const auto [width, height] = PhotoSize(first);
  if (set.crop_px == 0) return {width, height};
  if (set.crop_px > width || set.crop_px > height) {
    throw UserError(
        first, "size", fmt::format("{}x{}", width, height),
        fmt::format("the central {0}x{0} pixels are required; see --crop", set.crop_px));
  }
  return {set.crop_px, set.crop_px};
}

LinearPhoto ReadLinear(const ForeignView& view, const std::string& encoding_name,
                       const ImportOptions& options) {
  Photo photo = ReadPhoto(view.image);
  SaturationRule rule;
  rule.stored_level = options.saturation_level;
  if (options.float_saturation_level > 0) rule.float_level = options.float_saturation_level;
  const Encoding encoding = ResolveEncoding(encoding_name, view.image, photo);
  return LinearPhoto(std::move(photo), encoding, rule);
}

}  // namespace glint
