// The layout of DIR 2019's program: FOLDER/SOMETHING_wlv/NAME.txt beside
// FOLDER/SOMETHING_images/NAME_0.png … After a heading "predefined N: 20", lines of "light x,y,z
// <tab> camera x,y,z", on the plane [−1, 1]² in its own units, kept here as millimetres: the
// convention without falloff has no scale. E = π; images in gamma 2.2.
#include <numbers>

#include "base/errors/errors.h"
#include "datasets/import/foreign_set.h"
#include "datasets/import/number_file.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr double kSide_mm = 2;  // of the plane [−1, 1]²

// "example_wlv" to "example_images".
fs::path ImagesFolder(const fs::path& wlv_file) {
  const fs::path folder = fs::absolute(wlv_file).parent_path();
  const std::string name = folder.filename();
  const fs::path images = folder.parent_path() / (name.substr(0, name.size() - 3) + "images");
  if (!fs::is_directory(images)) {
    throw UserError(images, "", "no such folder", "put the images NAME_0.png … there");
  }
  return images;
}

}  // namespace

ForeignSet ReadDirSet(const fs::path& wlv_file) {
  ForeignSet set;
  set.layout = ForeignLayout::kDirWlv;
  set.description = {wlv_file};
  set.width_mm = set.height_mm = kSide_mm;
  set.encoding = "gamma2.2";
  set.convention = ReflectanceConvention::Dir2019();
  const auto rows = ReadNumberRows(wlv_file, 6, "predefined");
  const fs::path images = ImagesFolder(wlv_file);
  for (size_t i = 0; i < rows.size(); ++i) {
    const auto& n = rows[i].numbers;
    ForeignView view;
    view.name = wlv_file.stem().string() + "_" + std::to_string(i) + ".png";
    view.image = images / view.name;
    if (!fs::is_regular_file(view.image)) {
      throw UserError(view.image, "", "no such file",
                      wlv_file.filename().string() + " has " + std::to_string(rows.size()) +
                          " lines; give one image per line");
    }
    view.view.light_in_sample_mm = {n[0], n[1], n[2]};
    view.view.camera_in_sample_mm = {n[3], n[4], n[5]};
    view.view.light_rgb = {std::numbers::pi, std::numbers::pi, std::numbers::pi};
    RequireInFront(wlv_file, "line " + std::to_string(rows[i].line), view.view);
    set.views.push_back(view);
  }
  return set;
}

}  // namespace glint
