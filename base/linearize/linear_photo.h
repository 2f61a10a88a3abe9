// A photograph held as small as it came, read as linear radiance sample by sample.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <type_traits>
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
// floats are linearised in place.
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
    const float* data;
    float saturated_from;
    const ColourProfile::Matrix* rec709_from_rgb;
    Pixel At(size_t i) const {
      const float r = data[3 * i], g = data[3 * i + 1], b = data[3 * i + 2];
      return {InRec709({r, g, b}, rec709_from_rgb), std::max({r, g, b}) >= saturated_from};
    }
  };

  // Takes the photo's samples.
  LinearPhoto(Photo photo, const Encoding& encoding, const SaturationRule& saturation = {});

  int width() const { return image_.width; }
  int height() const { return image_.height; }
  bool is_float() const { return table_.empty(); }
  bool stored_linear() const { return stored_linear_; }  // without a camera's curve

  // Calls `f` with the storage's reader (Codes<uint8_t>, Codes<uint16_t> or Floats).
  template <class F>
  auto Visit(F&& f) const {
    const ColourProfile::Matrix* matrix = colour_.converts() ? &colour_.rec709_from_rgb : nullptr;
    return image_.Visit([&]<class T>(const std::vector<T>& samples) {
      if constexpr (std::is_floating_point_v<T>) {
        return f(Floats{samples.data(), saturated_value_, matrix});
      } else {
        return f(Codes<T>{samples.data(), Tables(), saturated_code_, matrix});
      }
    });
  }

 private:
  void MakeTables(const Encoding& encoding, const SaturationRule& saturation);
  void LineariseFloats(const Encoding& encoding, const SaturationRule& saturation,
                       std::vector<float>* samples);
  // One for all channels, or three.
  std::array<const float*, 3> Tables() const {
    const float* table = table_.data();
    const size_t step = table_.size() == codes_ ? 0 : codes_;
    return {table, table + step, table + 2 * step};
  }

  StoredImage image_;
  ColourProfile colour_;
  bool stored_linear_;
  size_t codes_ = 0;
  std::vector<float> table_;  // of codes
  int saturated_code_ = 0;
  float saturated_value_ = 0;
};

}  // namespace glint
