#include "datasets/map_formats/read_maps.h"

#include "base/errors/errors.h"
#include "base/formats/svbrdf_file.h"
#include "base/images/image.h"
#include "datasets/map_formats/map_folder.h"
#include "datasets/map_formats/map_strip.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr char kRemedy[] =
    "give an svbrdf.exr, a strip of four maps (normal, diffuse, roughness, specular) or of five (a "
    "photo before them), or a folder with NAME_Color, NAME_NormalGL and NAME_Roughness";

MapLayout DetectInFolder(const fs::path& folder) {
  if (fs::is_regular_file(folder / "svbrdf.exr")) return MapLayout::kSvbrdfExr;
  if (!FindMapFiles(folder).empty()) return MapLayout::kColorFolder;
  throw UserError(folder, "", "a folder without any known maps", kRemedy);
}

}  // namespace

std::string_view MapLayoutName(MapLayout layout) {
  switch (layout) {
    case MapLayout::kSvbrdfExr:
      return "svbrdf.exr";
    case MapLayout::kDirStrip:
      return "strip of four maps";
    case MapLayout::kPhotoStrip:
      return "strip of a photo and four maps";
    case MapLayout::kColorFolder:
      return "folder of maps";
  }
  return "";
}

MapLayout DetectMapLayout(const fs::path& path) {
  if (fs::is_directory(path)) return DetectInFolder(path);
  if (!fs::is_regular_file(path)) throw UserError(path, "", "no such file or folder", kRemedy);
  const ImageHeader header = ReadImageHeader(path);
  for (const std::string& channel : header.channels) {
    if (channel == "normal.X") return MapLayout::kSvbrdfExr;
  }
  if (header.width == 4 * header.height) return MapLayout::kDirStrip;
  if (header.width == 5 * header.height) return MapLayout::kPhotoStrip;
  throw UserError(
      path, "size",
      "a picture of " + std::to_string(header.width) + "x" + std::to_string(header.height),
      kRemedy);
}

SvbrdfMaps ReadMaps(const fs::path& path, const MapEncodings& encodings) {
  const MapLayout layout = DetectMapLayout(path);
  switch (layout) {
    case MapLayout::kSvbrdfExr:
      return ReadSvbrdf(fs::is_directory(path) ? path / "svbrdf.exr" : path);
    case MapLayout::kColorFolder:
      return ReadMapFolder(path);
    case MapLayout::kDirStrip:
    case MapLayout::kPhotoStrip:
      break;
  }
  return ReadMapStrip(path, layout, encodings);
}

}  // namespace glint
