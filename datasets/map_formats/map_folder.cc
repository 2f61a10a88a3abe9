#include "datasets/map_formats/map_folder.h"

#include <array>
#include <set>
#include <vector>

#include "base/errors/errors.h"
#include "base/images/image.h"
#include "base/linearize/encoding.h"
#include "base/photos/photo.h"
#include "datasets/map_formats/map_values.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

const std::set<std::string> kKinds = {"Color", "NormalGL", "Roughness", "Metalness"};
const std::set<std::string> kEndings = {".jpg", ".jpeg", ".png", ".tif", ".tiff", ".exr"};

// Reads `kind`, checked against the colour map's size.
Image ReadMap(const fs::path& folder, const std::map<std::string, fs::path>& files,
              const std::string& kind, const Image* color) {
  const auto found = files.find(kind);
  if (found == files.end()) {
    throw UserError(folder, kind, "no file named *_" + kind,
                    "put NAME_" + kind + ".png or .jpg there");
  }
  Image image = ReadPhoto(found->second).image.Planes();
  if (color != nullptr && (image.width != color->width || image.height != color->height)) {
    throw UserError(found->second, "size",
                    std::to_string(image.width) + "x" + std::to_string(image.height),
                    "the colour map is " + std::to_string(color->width) + "x" +
                        std::to_string(color->height) + "; give all maps the same size");
  }
  return image;
}

}  // namespace

std::map<std::string, fs::path> FindMapFiles(const fs::path& folder) {
  std::vector<fs::path> all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file()) all.push_back(entry.path());
  }
  std::map<std::string, fs::path> files;
  for (const fs::path& file : all) {
    const std::string stem = file.stem();
    const size_t underscore = stem.rfind('_');
    const std::string kind = underscore == std::string::npos ? "" : stem.substr(underscore + 1);
    if (kKinds.count(kind) == 0 || kEndings.count(file.extension()) == 0) continue;
    if (!files.emplace(kind, file).second) {
      throw UserError(folder, kind, "two files named *_" + kind,
                      "leave one material in the folder");
    }
  }
  return files;
}

SvbrdfMaps ReadMapFolder(const fs::path& folder) {
  const auto files = FindMapFiles(folder);
  const Image color = ReadMap(folder, files, "Color", nullptr);
  const Image normal = ReadMap(folder, files, "NormalGL", &color);
  const Image roughness = ReadMap(folder, files, "Roughness", &color);
  const bool has_metal = files.count("Metalness") > 0;
  const Image metalness = has_metal ? ReadMap(folder, files, "Metalness", &color) : Image();
  SvbrdfMaps maps(color.width, color.height);
  for (size_t i = 0; i < maps.texels(); ++i) {
    StoreNormal(normal.channel(0)[i], normal.channel(1)[i], normal.channel(2)[i], i, &maps);
    StoreRoughness(roughness.channel(0)[i], i, &maps);
    const float metal = has_metal ? std::clamp(metalness.channel(0)[i], 0.0f, 1.0f) : 0.0f;
    for (int c = 0; c < 3; ++c) {
      const float base = std::min(LinearFromEncoded(Encoding::kSrgb, color.channel(c)[i]), 1.0f);
      maps.plane(kDiffuseR + c)[i] = base * (1 - metal);
      maps.plane(kSpecularR + c)[i] = kDielectricF0 * (1 - metal) + base * metal;
    }
  }
  return maps;
}

}  // namespace glint
