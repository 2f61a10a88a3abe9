// A photograph held as small as it came, read as linear radiance sample by sample.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/linearize/encoding.h"
#include "base/photos/photo.h"

namespace glint {

// Sensor clipping: a stored value at or above `stored_level` carries no radiance any more. Floats
// (HDR) clip only where asked for.
struct SaturationRule {
  double stored_level = 0.995;  // 8 and 16 bit and RAW, on [0, 1] as stored, before linearisation
  double float_level = std::numeric_limits<double>::infinity();
};

// 8 and 16 bit samples stay codes that a table linearises on reading (36 MB for 12 MP of 8 bit);
// floats are linearised in place. Interleaved R, G, B codes, or three float planes.
class LinearPhoto {
 public:
  // One pixel: linear Rec.709, in colours beyond it with channels below 0, and whether any of the
  // three stored values had clipped.
  struct Pixel {
    std::array<float, 3> rgb;
    bool saturated;
  };

  static std::array<float, 3> InRec709(const std::array<float, 3>& rgb,
                                       const ColourProfile::Matrix* rec709_from_rgb) {
    return rec709_from_rgb == nullptr ? rgb : (*rec709_from_rgb)(rgb);
  }

  // Eight- and sixteen-bit codes: pixel i is data[3·i …]. `Code` is uint8_t or uint16_t.
  template <class Code>
  struct Codes {
    const Code* data;
    std::array<const float*, 3> table;
    int saturated_from;                            // first code that is clipped
    const ColourProfile::Matrix* rec709_from_rgb;  // null: they are
    Pixel At(size_t i) const {
      const Code* p = data + 3 * i;
      const int brightest = std::max({p[0], p[1], p[2]});
      return {InRec709({table[0][p[0]], table[1][p[1]], table[2][p[2]]}, rec709_from_rgb),
              brightest >= saturated_from};
    }
  };
  struct Floats {
    const float* plane;
    size_t pixels;
    float saturated_from;
    const ColourProfile::Matrix* rec709_from_rgb;
    Pixel At(size_t i) const {
      const float r = plane[i], g = plane[pixels + i], b = plane[2 * pixels + i];
      return {InRec709({r, g, b}, rec709_from_rgb), std::max({r, g, b}) >= saturated_from};
    }
  };

  // Takes the photo's samples (the float copy of an 8 or 16 bit photo is freed).
  LinearPhoto(Photo photo, const Encoding& encoding, const SaturationRule& saturation = {});

  int width() const { return width_; }
  int height() const { return height_; }
  bool is_float() const { return bits_ == 32; }

  // Calls `f` with the storage's reader (Codes<uint8_t>, Codes<uint16_t> or Floats).
  template <class F>
  auto Visit(F&& f) const {
    const ColourProfile::Matrix* matrix = colour_.converts() ? &colour_.rec709_from_rgb : nullptr;
    if (bits_ == 8) return f(Codes<uint8_t>{codes8_.data(), Tables(), saturated_code_, matrix});
    if (bits_ == 16) return f(Codes<uint16_t>{codes16_.data(), Tables(), saturated_code_, matrix});
    const size_t pixels = static_cast<size_t>(width_) * height_;
    return f(Floats{planes_.data(), pixels, saturated_value_, matrix});
  }

 private:
  // One for all channels, or three.
  std::array<const float*, 3> Tables() const {
    const float* table = table_.data();
    const size_t step = table_.size() == codes_ ? 0 : codes_;
    return {table, table + step, table + 2 * step};
  }

  int width_, height_, bits_;
  ColourProfile colour_;
  size_t codes_ = 0;
  std::vector<float> table_;
  int saturated_code_ = 0;
  float saturated_value_ = 0;
  std::vector<uint8_t> codes8_;
  std::vector<uint16_t> codes16_;
  std::vector<float> planes_;
};

}  // namespace glint
