#include "base/photos/exif.h"

#include <OpenImageIO/tiffutils.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/photos/heic_turn.h"
#include "base/photos/webp_facts.h"

namespace glint {
namespace {

// A number that means something; 0 for what is absent, not finite or negative.
double Positive(const OIIO::ImageSpec& spec, const char* name) {
  const OIIO::ParamValue* found = spec.find_attribute(name);
  if (found == nullptr) return 0;
  // OpenImageIO 2.4 makes 0 of a plain integer that is asked for as a float; LibRaw's ISO is one.
  const bool integer = found->type() == OIIO::TypeInt;
  const double value = integer ? found->get_int() : found->get_float();
  return std::isfinite(value) && value > 0 ? value : 0;
}

bool IsThereAndZero(const OIIO::ImageSpec& spec, const char* name) {
  return spec.find_attribute(name) != nullptr && Positive(spec, name) == 0;
}

int Dimension(const OIIO::ImageSpec& spec, const char* name) {
  const int value = spec.get_int_attribute(name, 0);
  return value > 0 && value < 1 << 20 ? value : 0;
}

// LibRaw tells its turn as dcraw does: 3 is half a turn, 5 anticlockwise, 6 clockwise.
int ExifFromRawFlip(int flip) {
  if (flip == 3 || flip == 6) return flip;
  return flip == 5 ? 8 : 1;
}

void ReadWhiteBalance(const OIIO::ImageSpec& spec, Photo* photo) {
  const OIIO::ParamValue* multipliers = spec.find_attribute("raw:cam_mul");
  if (multipliers == nullptr || multipliers->type().basetype != OIIO::TypeDesc::FLOAT ||
      multipliers->type().numelements() < 3) {
    return;
  }
  const float* m = static_cast<const float*>(multipliers->data());
  if (!(m[0] > 0 && m[1] > 0 && m[2] > 0)) return;
  photo->exif.white_balance = {m[0] / m[1], 1.0, m[2] / m[1]};
}

}  // namespace

Orientation OrientationOf(const std::filesystem::path& file, const OIIO::ImageInput& input) {
  const OIIO::ImageSpec& spec = input.spec();
  const std::string_view format = input.format_name();
  if (format == "raw") return {ExifFromRawFlip(spec.get_int_attribute("raw:flip", 0)), true};
  if (format == "heif") return {HeicOrientation(file), true};
  int orientation = spec.get_int_attribute("Orientation", 1);
  if (format == "webp") {
    OIIO::ImageSpec with_exif = spec;
    const WebpFacts facts = ReadWebpFacts(file);
    if (!facts.exif.empty()) OIIO::decode_exif(OIIO::string_view(facts.exif), with_exif);
    orientation = with_exif.get_int_attribute("Orientation", 1);
  }
  return {orientation >= 1 && orientation <= 8 ? orientation : 1, false};
}

void ReadExif(const OIIO::ImageSpec& spec, std::string_view format, Photo* photo) {
  photo->format = format;
  photo->focal_length_35mm = Positive(spec, "Exif:FocalLengthIn35mmFilm");
  photo->exposure_time_s = Positive(spec, "ExposureTime");
  photo->f_number = Positive(spec, "FNumber");
  photo->iso = Positive(spec, "Exif:PhotographicSensitivity");
  if (photo->iso == 0) photo->iso = Positive(spec, "Exif:ISOSpeedRatings");
  photo->camera_model = spec.get_string_attribute("Make");
  const std::string model = spec.get_string_attribute("Model");
  if (!photo->camera_model.empty() && !model.empty()) photo->camera_model += " ";
  photo->camera_model += model;

  ExifFacts& exif = photo->exif;
  exif.width_px = Dimension(spec, "Exif:PixelXDimension");
  exif.height_px = Dimension(spec, "Exif:PixelYDimension");
  exif.focal_length_mm = Positive(spec, "Exif:FocalLength");
  exif.focal_is_zero = IsThereAndZero(spec, "Exif:FocalLength");
  exif.iso_is_zero = photo->iso == 0 && (IsThereAndZero(spec, "Exif:PhotographicSensitivity") ||
                                         IsThereAndZero(spec, "Exif:ISOSpeedRatings"));
  exif.digital_zoom = Positive(spec, "Exif:DigitalZoomRatio");
  // APEX: Tv = −log2(time), Av = 2·log2(f-number). 0 is what cameras write that do not know.
  const float tv = spec.get_float_attribute("Exif:ShutterSpeedValue", 0);
  const float av = spec.get_float_attribute("Exif:ApertureValue", 0);
  if (tv != 0 && std::abs(tv) < 30) exif.shutter_s = std::exp2(-tv);
  if (av > 0 && av < 30) exif.aperture_f = std::exp2(0.5 * av);
  exif.colour_space = spec.get_int_attribute("Exif:ColorSpace", 0);
  exif.flash = spec.get_int_attribute("Exif:Flash", -1);
  if (format == "raw" && exif.flash == 0) exif.flash = -1;  // LibRaw's 0 is "not told", too
  ReadWhiteBalance(spec, photo);
}

}  // namespace glint
