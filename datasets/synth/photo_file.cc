#include "datasets/synth/photo_file.h"

#include <OpenImageIO/imageio.h>

#include <cmath>

#include "base/errors/errors.h"

namespace glint {
namespace {

void AddExif(const PhotoFacts& facts, OIIO::ImageSpec* spec) {
  spec->attribute("Make", "Glint");
  spec->attribute("Model", "synthetic phone");
  spec->attribute("Orientation", 1);
  if (facts.focal_length_35mm > 0) {
    spec->attribute("Exif:FocalLengthIn35mmFilm",
                    static_cast<int>(std::lround(facts.focal_length_35mm)));
  }
  if (facts.focal_length_mm > 0) {
    spec->attribute("Exif:FocalLength", static_cast<float>(facts.focal_length_mm));
  }
  if (facts.exposure_time_s > 0) {
    spec->attribute("ExposureTime", static_cast<float>(facts.exposure_time_s));
  }
  if (facts.f_number > 0) spec->attribute("FNumber", static_cast<float>(facts.f_number));
  if (facts.iso > 0) {
    spec->attribute("Exif:PhotographicSensitivity", static_cast<int>(std::lround(facts.iso)));
  }
  spec->attribute("Exif:Flash", 1);
}

[[noreturn]] void Fail(const std::filesystem::path& file, const std::string& reason) {
  throw EnvironmentError(file.string() + ": cannot be written: " + reason +
                         "; check the folder's permissions and the free space");
}

}  // namespace

void WritePhoto(const std::filesystem::path& file, int width, int height,
                const std::vector<unsigned char>& rgb, const PhotoFacts& facts) {
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("CompressionQuality", facts.jpeg_quality);
  spec.attribute("jpeg:subsampling", "4:2:0");
  AddExif(facts, &spec);
  const auto output = OIIO::ImageOutput::create(file.string());
  if (!output) Fail(file, OIIO::geterror());
  if (!output->open(file.string(), spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, rgb.data()) || !output->close()) {
    Fail(file, output->geterror());
  }
}

}  // namespace glint
