// Photographs as cameras write them: see ReadPhoto in photo.h.
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/tiffutils.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/images/image.h"
#include "base/images/image_format.h"
#include "base/images/jpeg_segments.h"
#include "base/images/oiio.h"
#include "base/photos/decode_count.h"
#include "base/photos/exif.h"
#include "base/photos/heif_facts.h"
#include "base/photos/jpeg_end.h"
#include "base/photos/photo.h"
#include "base/photos/photo_header.h"
#include "base/photos/photo_name.h"
#include "base/photos/upright.h"
#include "base/photos/video.h"
#include "base/photos/webp_facts.h"

namespace glint {
namespace {

constexpr int kSmallestSide_px = 16;
constexpr std::size_t kMaxJpegBytes = 512u << 20;

OIIO::ImageSpec Configuration() {
  OIIO::ImageSpec configuration;
  configuration.attribute("oiio:UnassociatedAlpha", 1);
  configuration.attribute("raw:ColorSpace", "linear");
  // One scale for all photographs of a camera: nothing that follows the picture's content.
  configuration.attribute("raw:use_camera_wb", 1);
  configuration.attribute("raw:auto_bright", 0);
  configuration.attribute("raw:adjust_maximum_thr", 0.0f);
  configuration.attribute("raw:HighlightMode", 0);  // clip: saturated pixels have a channel at 1
  return configuration;
}

// `jpeg`: the file's bytes; empty: it is none.
void RequireWholeJpeg(const std::filesystem::path& file, std::string_view jpeg) {
  if (jpeg.empty() || JpegIsComplete(jpeg)) return;
  throw UserError(file, "", "a truncated JPEG file, which ends before its image is complete",
                  "copy the photograph again, or remove it");
}

void RequireFinite(const std::filesystem::path& file, const StoredImage& image) {
  const size_t at = image.Visit([](const auto& samples) {
    const auto found = std::find_if_not(samples.begin(), samples.end(), [](auto sample) {
      return std::isfinite(static_cast<float>(sample));
    });
    return static_cast<size_t>(found - samples.begin()) / 3;
  });
  if (at >= image.pixels()) return;
  const size_t width = static_cast<size_t>(image.width);
  throw UserError(file,
                  "pixel (" + std::to_string(at % width) + ", " + std::to_string(at / width) + ")",
                  "a value that is not a number", "export the photograph again, or remove it");
}

// LibRaw leaves what it could not read black, and reports it to nobody.
void RequireWholeRaw(const std::filesystem::path& file, const Photo& photo) {
  if (photo.format != "raw") return;
  const bool black = photo.image.Visit([](const auto& samples) {
    return std::none_of(samples.begin(), samples.end(), [](auto sample) { return sample > 0; });
  });
  if (!black) return;
  throw UserError(file, "", "a RAW file without an image: truncated or damaged",
                  "copy the photograph again, or remove it");
}

// Of PNG and TIFF, as OpenImageIO hands it on.
std::string_view IccOf(const OIIO::ImageSpec& spec) {
  const OIIO::ParamValue* icc = spec.find_attribute("ICCProfile");
  if (icc == nullptr || icc->type().basetype != OIIO::TypeDesc::UINT8) return {};
  return {static_cast<const char*>(icc->data()), icc->type().size()};
}

// What PNG and EXR say of their colours in fields of their own.
ColourProfile ToldWithoutProfile(const OIIO::ImageSpec& spec, std::string_view format) {
  if (format == "png") return ProfileOfGamma(spec.get_float_attribute("oiio:Gamma", 0));
  std::array<float, 8> xy{};
  const OIIO::TypeDesc type(OIIO::TypeDesc::FLOAT, static_cast<int>(xy.size()));
  if (format != "openexr" || !spec.getattribute("chromaticities", type, xy.data())) return {};
  return ProfileOfChromaticities(xy);
}

std::string BytesOfJpeg(const std::filesystem::path& file, const OIIO::ImageInput& input) {
  if (std::string_view(input.format_name()) != "jpeg") return {};
  return ReadTextFile(file, kMaxJpegBytes);
}

// EXIF and colours. `jpeg` as above.
void ReadFacts(const std::filesystem::path& file, const OIIO::ImageInput& input,
               std::string_view jpeg, Photo* photo) {
  const std::string_view format = input.format_name();
  OIIO::ImageSpec spec = input.spec();
  if (format == "heif") {
    const HeifFacts facts = ReadHeifFacts(file);
    if (!facts.exif.empty()) OIIO::decode_exif(OIIO::string_view(facts.exif), spec);
    photo->colour = facts.colour;
  } else if (format == "jpeg") {
    photo->colour = ReadColourProfile(IccOfJpeg(jpeg));
  } else if (format == "webp") {
    const WebpFacts facts = ReadWebpFacts(file);
    if (!facts.exif.empty()) OIIO::decode_exif(OIIO::string_view(facts.exif), spec);
    photo->colour = ReadColourProfile(facts.icc);
  } else if (format != "raw") {
    photo->colour = ReadColourProfile(IccOf(spec));
    if (photo->colour.name.empty()) photo->colour = ToldWithoutProfile(spec, format);
  }
  ReadExif(spec, format, photo);
  photo->grey = spec.nchannels < 3;
  constexpr int kExifAdobeRgb = 2;
  if (photo->colour.name.empty() && photo->exif.colour_space == kExifAdobeRgb) {
    photo->colour = AdobeRgbProfile();
  }
}

// The turn that is left to do, 1 … 8.
int TurnToApply(const Orientation& orientation) {
  return orientation.applied ? 1 : orientation.exif;
}

template <class T>
StoredImage ReadUpright(const std::filesystem::path& file, OIIO::ImageInput* input,
                        OIIO::TypeDesc type, int turn) {
  const OIIO::ImageSpec& spec = input->spec();
  return UprightImage(ReadSamples<T>(file, input, type), {spec.width, spec.height, spec.nchannels},
                      turn);
}

void ReadPixels(const std::filesystem::path& file, OIIO::ImageInput* input, int turn,
                Photo* photo) {
  const OIIO::TypeDesc format = input->spec().format;
  if (format.is_floating_point()) {
    photo->bits = 32;
    photo->image = ReadUpright<float>(file, input, OIIO::TypeFloat, turn);
    RequireFinite(file, photo->image);
  } else if (format.basesize() > 1) {
    photo->bits = 16;
    photo->image = ReadUpright<std::uint16_t>(file, input, OIIO::TypeUInt16, turn);
  } else {
    photo->bits = 8;
    photo->image = ReadUpright<std::uint8_t>(file, input, OIIO::TypeUInt8, turn);
  }
}

void RequireSize(const std::filesystem::path& file, int width, int height) {
  if (width >= kSmallestSide_px && height >= kSmallestSide_px) return;
  throw UserError(file, "size", std::to_string(width) + "x" + std::to_string(height) + " pixels",
                  "a photograph of at least " + std::to_string(kSmallestSide_px) +
                      " pixels per side is expected");
}

std::shared_ptr<OIIO::ImageInput> OpenPhoto(const std::filesystem::path& file) {
  if (IsVideoFileName(file)) {
    throw UserError(
        file, "", "a video where a photograph is expected",
        "name it in capture.toml: [photos] video = \"" + file.filename().string() + "\"");
  }
  const OIIO::ImageSpec configuration = Configuration();
  auto input = OpenImage(file, &configuration);
  // RAW formats are TIFF files too, whose first picture is a thumbnail.
  const std::string_view format = input->format_name();
  if (IsRawFileName(file) && format != "raw") {
    throw UserError(file, "",
                    "no RAW picture that LibRaw can read, but a " + std::string(format) +
                        " file or the preview of an unknown camera",
                    "convert it to DNG or to 16-bit TIFF, or rename it if it is not a RAW file");
  }
  return input;
}

}  // namespace

Photo ReadPhoto(const std::filesystem::path& file) {
  const PhotoName name = SplitPhotoName(file);
  if (name.frame >= 0) {
    Photo frame = ReadVideoFrame(name.file, name.frame);
    CountDecodedPhoto();
    return frame;
  }
  const auto input = OpenPhoto(file);
  RequireSize(file, input->spec().width, input->spec().height);
  const std::string jpeg = BytesOfJpeg(file, *input);
  RequireWholeJpeg(file, jpeg);
  Photo photo;
  ReadFacts(file, *input, jpeg, &photo);
  const Orientation orientation = OrientationOf(file, *input);
  photo.orientation = orientation.exif;
  ReadPixels(file, input.get(), TurnToApply(orientation), &photo);
  RequireWholeRaw(file, photo);
  CountDecodedPhoto();
  return photo;
}

PhotoHeader ReadPhotoHeader(const std::filesystem::path& file) {
  PhotoHeader header;
  const PhotoName name = SplitPhotoName(file);
  if (name.frame >= 0) {
    header.photo.format = "video";
    std::tie(header.stored_width, header.stored_height) = VideoFrameSize(name.file);
    return header;
  }
  const auto input = OpenPhoto(file);
  header.is_jpeg = std::string_view(input->format_name()) == "jpeg";
  header.stored_width = input->spec().width;
  header.stored_height = input->spec().height;
  ReadFacts(file, *input, BytesOfJpeg(file, *input), &header.photo);
  header.photo.orientation = OrientationOf(file, *input).exif;
  return header;
}

std::pair<int, int> PhotoSize(const std::filesystem::path& file) {
  const PhotoName name = SplitPhotoName(file);
  if (name.frame >= 0) return VideoFrameSize(name.file);
  const auto input = OpenPhoto(file);
  const OIIO::ImageSpec& spec = input->spec();
  if (TurnExchangesAxes(TurnToApply(OrientationOf(file, *input)))) return {spec.height, spec.width};
  return {spec.width, spec.height};
}

}  // namespace glint
