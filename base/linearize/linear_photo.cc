#include "base/linearize/linear_photo.h"

#include <cmath>
#include <utility>

namespace glint {
namespace {

// Undoes ReadPhoto's division; exact, since floats hold every 16-bit code.
template <class Code>
std::vector<Code> Pack(const Image& image) {
  constexpr float kMax = std::numeric_limits<Code>::max();
  const size_t pixels = image.pixels();
  std::vector<Code> codes(3 * pixels);
  for (size_t c = 0; c < 3; ++c) {
    const float* from = image.samples.data() + c * pixels;
    for (size_t i = 0; i < pixels; ++i) {
      codes[3 * i + c] = static_cast<Code>(std::clamp(from[i], 0.0f, 1.0f) * kMax + 0.5f);
    }
  }
  return codes;
}

}  // namespace

LinearPhoto::LinearPhoto(Photo photo, const Encoding& encoding, const SaturationRule& saturation)
    : width_(photo.image.width),
      height_(photo.image.height),
      bits_(photo.bits),
      colour_(std::move(photo.colour)) {
  if (bits_ == 8 || bits_ == 16) {
    const int codes = bits_ == 8 ? 256 : 65536;
    codes_ = static_cast<size_t>(codes);
    const int tables = encoding.kind() == Encoding::kResponse ? 3 : 1;
    for (int c = 0; c < tables; ++c) {
      const std::vector<float> table = LinearTable(encoding, codes, c);
      table_.insert(table_.end(), table.begin(), table.end());
    }
    saturated_code_ = static_cast<int>(std::ceil(saturation.stored_level * (codes - 1)));
    if (bits_ == 8) {
      codes8_ = Pack<uint8_t>(photo.image);
    } else {
      codes16_ = Pack<uint16_t>(photo.image);
    }
    return;
  }
  bits_ = 32;
  planes_ = std::move(photo.image.samples);
  saturated_value_ = static_cast<float>(saturation.float_level);
  if (std::isfinite(saturation.float_level)) {
    saturated_value_ = LinearFromEncoded(encoding, saturated_value_);
  }
  const size_t pixels = planes_.size() / 3;
  for (size_t i = 0; i < planes_.size(); ++i) {
    planes_[i] = LinearFromEncoded(encoding, planes_[i], static_cast<int>(i / pixels));
  }
}

}  // namespace glint
