// Photographs as cameras write them: see ReadPhoto in image.h.
#include <OpenImageIO/imageio.h>

#include <cmath>

#include "pipeline/contract/errors.h"
#include "pipeline/contract/files.h"
#include "pipeline/contract/image.h"
#include "pipeline/contract/jpeg_end.h"
#include "pipeline/contract/oiio.h"
#include "pipeline/contract/photo_header.h"

namespace glint {
namespace {

constexpr int kSmallestSide_px = 16;
constexpr std::size_t kMaxJpegBytes = 512u << 20;

// EXIF orientations 5–8 exchange width and height.
bool ExchangesAxes(int orientation) { return orientation >= 5; }

// Source pixel of the upright pixel (x, y) in an image stored as width × height.
std::pair<int, int> StoredPixel(int orientation, int x, int y, int width, int height) {
  switch (orientation) {
    case 2:
      return {width - 1 - x, y};
    case 3:
      return {width - 1 - x, height - 1 - y};
    case 4:
      return {x, height - 1 - y};
    case 5:
      return {y, x};
    case 6:
      return {y, height - 1 - x};
    case 7:
      return {width - 1 - y, height - 1 - x};
    case 8:
      return {width - 1 - y, x};
    default:
      return {x, y};
  }
}

OIIO::ImageSpec Configuration() {
  OIIO::ImageSpec configuration;
  configuration.attribute("oiio:UnassociatedAlpha", 1);
  configuration.attribute("raw:ColorSpace", "linear");
  configuration.attribute("oiio:reorient", 0);  // HEIC: leave the turning to us
  return configuration;
}

int Orientation(const OIIO::ImageSpec& spec) {
  const int orientation = spec.get_int_attribute("Orientation", 1);
  return orientation >= 1 && orientation <= 8 ? orientation : 1;
}

template <class T>
void Unpack(const std::vector<T>& samples, const OIIO::ImageSpec& spec, double scale,
            Image* image) {
  const int orientation = Orientation(spec);
  const int stored_channels = spec.nchannels;
  const bool grey = stored_channels < 3;
  const float factor = static_cast<float>(scale);
  for (int y = 0; y < image->height; ++y) {
    for (int x = 0; x < image->width; ++x) {
      const auto [sx, sy] = StoredPixel(orientation, x, y, spec.width, spec.height);
      const T* pixel =
          samples.data() + (static_cast<size_t>(sy) * spec.width + sx) * stored_channels;
      const size_t at = static_cast<size_t>(y) * image->width + x;
      for (int c = 0; c < 3; ++c) {
        image->samples[c * image->pixels() + at] = static_cast<float>(pixel[grey ? 0 : c]) * factor;
      }
    }
  }
}

void ReadExif(const OIIO::ImageSpec& spec, Photo* photo) {
  photo->orientation = Orientation(spec);
  photo->focal_length_35mm = spec.get_float_attribute("Exif:FocalLengthIn35mmFilm", 0);
  photo->exposure_time_s = spec.get_float_attribute("ExposureTime", 0);
  photo->f_number = spec.get_float_attribute("FNumber", 0);
  photo->iso = spec.get_float_attribute("Exif:PhotographicSensitivity", 0);
  if (photo->iso == 0) photo->iso = spec.get_float_attribute("Exif:ISOSpeedRatings", 0);
  photo->camera_model = spec.get_string_attribute("Make");
  const std::string model = spec.get_string_attribute("Model");
  if (!photo->camera_model.empty() && !model.empty()) photo->camera_model += " ";
  photo->camera_model += model;
}

void RequireWholeJpeg(const std::filesystem::path& file, const OIIO::ImageInput& input) {
  if (std::string_view(input.format_name()) != "jpeg") return;
  if (JpegIsComplete(ReadTextFile(file, kMaxJpegBytes))) return;
  throw UserError(file, "", "a truncated JPEG file, which ends before its picture does",
                  "copy the photograph again, or take it out");
}

void RequireFinite(const std::filesystem::path& file, const Image& image) {
  for (size_t i = 0; i < image.samples.size(); ++i) {
    if (std::isfinite(image.samples[i])) continue;
    const size_t at = i % image.pixels();
    throw UserError(file,
                    "pixel (" + std::to_string(at % image.width) + ", " +
                        std::to_string(at / image.width) + ")",
                    "a value that is not a number", "write the photograph again, or take it out");
  }
}

}  // namespace

Photo ReadPhoto(const std::filesystem::path& file) {
  const OIIO::ImageSpec configuration = Configuration();
  const auto input = OpenImage(file, &configuration);
  const OIIO::ImageSpec spec = input->spec();
  if (spec.width < kSmallestSide_px || spec.height < kSmallestSide_px) {
    throw UserError(file, "size",
                    std::to_string(spec.width) + "x" + std::to_string(spec.height) + " pixels",
                    "a photograph of at least " + std::to_string(kSmallestSide_px) +
                        " pixels a side is expected");
  }
  RequireWholeJpeg(file, *input);
  Photo photo;
  const bool turned = ExchangesAxes(Orientation(spec));
  photo.image =
      Image(turned ? spec.height : spec.width, turned ? spec.width : spec.height, {"R", "G", "B"});
  if (spec.format.is_floating_point()) {
    photo.bits = 32;
    Unpack(ReadSamples<float>(file, input.get(), OIIO::TypeFloat), spec, 1.0, &photo.image);
    RequireFinite(file, photo.image);
  } else if (spec.format.basesize() > 1) {
    photo.bits = 16;
    Unpack(ReadSamples<std::uint16_t>(file, input.get(), OIIO::TypeUInt16), spec, 1.0 / 65535,
           &photo.image);
  } else {
    photo.bits = 8;
    Unpack(ReadSamples<std::uint8_t>(file, input.get(), OIIO::TypeUInt8), spec, 1.0 / 255,
           &photo.image);
  }
  ReadExif(spec, &photo);
  return photo;
}

PhotoHeader ReadPhotoHeader(const std::filesystem::path& file) {
  const OIIO::ImageSpec configuration = Configuration();
  const auto input = OpenImage(file, &configuration);
  const OIIO::ImageSpec& spec = input->spec();
  PhotoHeader header;
  header.is_jpeg = std::string_view(input->format_name()) == "jpeg";
  header.stored_width = spec.width;
  header.stored_height = spec.height;
  ReadExif(spec, &header.photo);
  return header;
}

std::pair<int, int> PhotoSize(const std::filesystem::path& file) {
  const OIIO::ImageSpec configuration = Configuration();
  const auto input = OpenImage(file, &configuration);
  const OIIO::ImageSpec& spec = input->spec();
  if (ExchangesAxes(Orientation(spec))) return {spec.height, spec.width};
  return {spec.width, spec.height};
}

}  // namespace glint
