// Images in memory, and as Glint writes them: EXR and PNG.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace glint {

inline const std::vector<std::string> kRgbChannels = {"R", "G", "B"};

// float32, planar: channel c is the contiguous block [c·H·W, (c+1)·H·W), rows top to bottom.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;  // "R", "G", "B", "mask.Y", "normal.X" …
  std::vector<float> samples;

  Image() = default;
  Image(int width_in, int height_in, std::vector<std::string> channels_in)
      : width(width_in),
        height(height_in),
        channels(std::move(channels_in)),
        samples(channels.size() * static_cast<size_t>(width) * height, 0.0f) {}

  size_t pixels() const { return static_cast<size_t>(width) * height; }
  std::span<float> channel(int c) { return {samples.data() + c * pixels(), pixels()}; }
  std::span<const float> channel(int c) const { return {samples.data() + c * pixels(), pixels()}; }
  // Index of a channel by name; −1: absent.
  int ChannelIndex(const std::string& name) const;
};

// float32 scan-line EXR, piz, linear Rec.709 chromaticities, no time stamp: identical inputs give
// identical bytes. `attributes` become string attributes "glint:<name>". Throws EnvironmentError.
void WriteExr(const std::filesystem::path& file, const Image& image,
              const std::map<std::string, std::string>& attributes = {});

// Any EXR; channels in file order. Throws UserError.
Image ReadExr(const std::filesystem::path& file,
              std::map<std::string, std::string>* attributes = nullptr);

// What a PNG tells of itself.
enum class PngTransfer {
  kUntold,  // viewers show it as they show any picture
  kSrgb,    // chunks sRGB and gAMA
};
struct PngTags {
  PngTransfer transfer = PngTransfer::kUntold;
  double pixels_per_m = 0;  // chunk pHYs; 0: untold
};

// 8 or 16 bit PNG (1, 3 or 4 channels), values clamped to [0, 1], rounded and written as they are.
// Throws EnvironmentError.
void WritePng(const std::filesystem::path& file, const Image& image, int bits = 8,
              const PngTags& tags = {});
// The bytes of such a file.
std::string EncodePng(const Image& image, int bits = 8, const PngTags& tags = {});

// An 8 bit PNG such as WritePng makes, as red, green and blue of 0 … 1. Throws UserError.
Image ReadPng(const std::filesystem::path& file);

// Size and channels, from an image's header alone. Throws UserError.
struct ImageHeader {
  int width = 0, height = 0;
  std::vector<std::string> channels;
};
ImageHeader ReadExrHeader(const std::filesystem::path& file);
ImageHeader ReadPngHeader(const std::filesystem::path& file);
// Of any image that Glint reads (image_format.h).
ImageHeader ReadImageHeader(const std::filesystem::path& file);

}  // namespace glint
