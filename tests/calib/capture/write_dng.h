// A RAW file as a camera writes it, for tests: an uncompressed 16-bit RGGB mosaic whose camera
// space is linear Rec.709 (DNG 1.4, Adobe).
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace glint::testing {

class DngWriter {
 public:
  // `linear` in [0, 1] of pixel (x, y); grey.
  void Write(const std::filesystem::path& file, int width, int height, int orientation,
             const std::function<double(int x, int y)>& linear) {
    const auto w = static_cast<std::uint32_t>(width), h = static_cast<std::uint32_t>(height);
    entries_.clear();
    Long(254, {0});  // the whole picture
    Long(256, {w});
    Long(257, {h});
    Short(258, {16});     // bits
    Short(259, {1});      // uncompressed
    Short(262, {32803});  // mosaic
    Text(271, "Glint");
    Text(272, "Test");
    Long(273, {0});  // where the samples begin; filled in below
    Short(274, {static_cast<std::uint16_t>(orientation)});
    Short(277, {1});
    Long(278, {h});
    Long(279, {2 * w * h});
    Short(33421, {2, 2});        // the mosaic's period …
    Bytes(33422, {0, 1, 1, 2});  // … and colours
    Bytes(50706, {1, 4, 0, 0});  // DNG's version
    Text(50708, "Glint Test");
    Short(50714, {0});     // black
    Long(50717, {65535});  // white
    Ratios(50721, 10, {32405, -15371, -4985, -9693, 18760, 416, 556, -2040, 10572}, 10000);
    Ratios(50728, 5, {1, 1, 1}, 1);  // as shot: neutral
    Short(50778, {21});              // D65
    std::ofstream stream(file, std::ios::binary);
    const std::string header = Header();
    stream.write(header.data(), static_cast<std::streamsize>(header.size()));
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const std::string code = Number(static_cast<std::uint32_t>(65535 * linear(x, y) + 0.5), 2);
        stream.write(code.data(), 2);
      }
    }
  }

 private:
  struct Entry {
    std::uint32_t tag, type, count;
    std::string value;
  };

  static std::string Number(std::uint32_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xff);
    return text;
  }
  void Add(std::uint32_t tag, std::uint32_t type, int bytes,
           const std::vector<std::uint32_t>& values) {
    std::string text;
    for (const std::uint32_t value : values) text += Number(value, bytes);
    entries_.push_back({tag, type, static_cast<std::uint32_t>(values.size()), text});
  }
  void Bytes(std::uint32_t tag, const std::vector<std::uint32_t>& v) { Add(tag, 1, 1, v); }
  void Short(std::uint32_t tag, const std::vector<std::uint32_t>& v) { Add(tag, 3, 2, v); }
  void Long(std::uint32_t tag, const std::vector<std::uint32_t>& v) { Add(tag, 4, 4, v); }
  void Text(std::uint32_t tag, const std::string& text) {
    entries_.push_back({tag, 2, static_cast<std::uint32_t>(text.size() + 1), text + '\0'});
  }
  void Ratios(std::uint32_t tag, std::uint32_t type, const std::vector<int>& above, int below) {
    std::string text;
    for (const int value : above) {
      text += Number(static_cast<std::uint32_t>(value), 4);
      text += Number(static_cast<std::uint32_t>(below), 4);
    }
    entries_.push_back({tag, type, static_cast<std::uint32_t>(above.size()), text});
  }

  std::string Header() {
    const size_t start = 8 + 2 + 12 * entries_.size() + 4;
    size_t end = start;
    for (const Entry& entry : entries_) end += entry.value.size() > 4 ? entry.value.size() : 0;
    std::string directory, values;
    for (Entry& entry : entries_) {
      if (entry.tag == 273) entry.value = Number(static_cast<std::uint32_t>(end), 4);
      directory += Number(entry.tag, 2) + Number(entry.type, 2) + Number(entry.count, 4);
      if (entry.value.size() > 4) {
        directory += Number(static_cast<std::uint32_t>(start + values.size()), 4);
        values += entry.value;
      } else {
        directory += entry.value + std::string(4 - entry.value.size(), '\0');
      }
    }
    return std::string("II*\0", 4) + Number(8, 4) +
           Number(static_cast<std::uint32_t>(entries_.size()), 2) + directory + Number(0, 4) +
           values;
  }

  std::vector<Entry> entries_;
};

}  // namespace glint::testing
