// Photographs as cameras write them.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>

#include "base/images/image.h"
#include "base/photos/colour_profile.h"
#include "base/photos/stored_image.h"

namespace glint {

// What the file tells of the taking of a photograph, as it tells it (EXIF, RAW, the container of a
// video). 0 or empty: it does not tell.
struct ExifFacts {
  int width_px = 0, height_px = 0;  // of the picture as stored, by EXIF; contradicts a cropped one
  double focal_length_mm = 0;
  double digital_zoom = 0;
  double shutter_s = 0;        // from ShutterSpeedValue, which should agree with the exposure time
  double aperture_f = 0;       // from ApertureValue, which should agree with the f-number
  int flash = -1;              // EXIF's bits, the lowest: it fired; −1: not told
  int colour_space = 0;        // EXIF's ColorSpace: 1 sRGB, 2 Adobe RGB, 65535 another
  bool focal_is_zero = false;  // a tag is there, and holds nothing
  bool iso_is_zero = false;
  std::array<double, 3> white_balance{0, 0, 0};  // RAW: multipliers of R, G, B; G is 1
};

// What a camera wrote: samples as stored, orientation applied, alpha dropped, grey widened to RGB.
// RAW: demosaiced, camera's white balance, linear Rec.709 primaries, no tone curve, clipped at 1.
struct Photo {
  StoredImage image;   // not linearised
  int bits = 8;        // 8, 16, or 32 for float
  std::string format;  // OpenImageIO's name: "jpeg", "heif", "raw", "tiff"…; "video" for a frame
  bool is_float() const { return bits == 32; }
  bool grey = false;             // it was stored without colour; R, G and B are the same
  ColourProfile colour;          // what R, G and B are; RAW is developed to Rec.709
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
