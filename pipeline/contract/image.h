// Images in memory and on disk, through OpenImageIO.
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

// Largest image that is read (pixels); larger ones are refused before they are allocated.
inline constexpr std::size_t kMaxPixels = 512u << 20;

// float32 scan-line EXR, ZIP, linear Rec.709 chromaticities, no time stamp: identical inputs give
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

// Size and channels of any image, from its header alone. Throws UserError.
struct ImageHeader {
  int width = 0, height = 0;
  std::vector<std::string> channels;
};
ImageHeader ReadImageHeader(const std::filesystem::path& file);

// What the file tells of the taking of a photograph, as it tells it (EXIF, RAW, the container of a
// video). 0 or empty: it does not tell.
struct ExifFacts {
  int width_px = 0, height_px = 0;  // of the picture as stored, by EXIF; contradicts a cropped one
  double focal_length_mm = 0;
  double digital_zoom = 0;
  double shutter_s = 0;        // from ShutterSpeedValue, which should agree with the exposure time
  double aperture_f = 0;       // from ApertureValue, which should agree with the f-number
  int flash = -1;              // EXIF's bits, the lowest: it fired; −1: not told
  bool focal_is_zero = false;  // a tag is there, and holds nothing
  bool iso_is_zero = false;
  std::array<double, 3> white_balance{0, 0, 0};  // RAW: multipliers of R, G, B; G is 1
};

// What a camera wrote: samples as stored (8/16 bit divided by 255/65535; float as is), orientation
// applied, alpha dropped, grey widened to RGB. RAW: demosaiced, camera's white balance, linear
// Rec.709 primaries, no tone curve, clipped at 1.
struct Photo {
  Image image;         // R, G, B; not linearised
  int bits = 8;        // 8, 16, or 32 for float
  std::string format;  // OpenImageIO's name: "jpeg", "heif", "raw", "tiff"…; "video" for a frame
  bool is_float() const { return bits == 32; }
  double focal_length_35mm = 0;  // EXIF; 0: absent
  double exposure_time_s = 0, iso = 0, f_number = 0;
  std::string camera_model;  // EXIF make and model
  int orientation = 1;       // 1 … 8 as in EXIF, as it was before it was applied
  ExifFacts exif;
  // time · ISO / f-number², to which the samples are proportional; 0: EXIF does not tell all three.
  double exposure() const {
    if (!(exposure_time_s > 0 && iso > 0 && f_number > 0)) return 0;
    return exposure_time_s * iso / (f_number * f_number);
  }
};

// JPEG, PNG, TIFF, EXR, HEIC, RAW…, or a frame of a video (see photo_name.h). Throws UserError
// (missing, empty, truncated, not an image, too large, NaN, RAW of a camera LibRaw does not know),
// EnvironmentError (no decoder installed).
Photo ReadPhoto(const std::filesystem::path& file);

// Width and height as ReadPhoto would give them, from the header alone.
std::pair<int, int> PhotoSize(const std::filesystem::path& file);

}  // namespace glint
