// Views that another program rectified, as its files describe them, before any image is read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/reflectance/view.h"

namespace glint {

struct ForeignView {
  std::filesystem::path image;
  std::string name;         // how the set calls it: a path within the source, such as "00.png"
  View view;                // sample frame, millimetres
  std::optional<bool> ldr;  // whether the image clips at 1; absent: 8 and 16 bit do
};

enum class ForeignLayout { kViewsJson, kMaterialGanText, kMaterialGanJson, kDirWlv };
std::string_view ForeignLayoutName(ForeignLayout layout);

struct ForeignSet {
  ForeignLayout layout = ForeignLayout::kViewsJson;
  std::vector<std::filesystem::path> description;  // the files that were read
  std::vector<ForeignView> views;
  double width_mm = 0, height_mm = 0;  // of what the images show, after cropping
  int crop_px = 0;                     // the sample is the central crop_px pixels; 0: all
  std::string encoding = "auto";       // of the images, as ResolveEncoding takes it
  ReflectanceConvention convention;
  bool light_power_known = true;  // false: the views' light_rgb are a first guess
  bool light_power_given = true;  // false: there is no light_rgb at all
  // Height of the sample above the plane that the images were rectified for, where it is known.
  std::optional<double> plane_mm;

  // Renderings of the paper's synthetic geometry are in place.
  bool photographs() const { return convention != ReflectanceConvention::Dir2019(); }
};

// `source` is a folder or a file:
//   views.json or a folder with one              docs/views.md
//   a folder with camera_pos.txt                 MaterialGAN (Guo et al. 2020)
//   a folder with parameters.json                svbrdf-diff-renderer, by the same authors
//   NAME.txt in a folder *wlv beside *images     DIR 2019's program; or the folder above with one
//   such
// Throws UserError naming file, field, what was found and the remedy.
ForeignSet ReadForeignSet(const std::filesystem::path& source);

// The layouts' readers, for files known to be theirs.
ForeignSet ReadViewsJson(const std::filesystem::path& file);
ForeignSet ReadMaterialGanText(const std::filesystem::path& folder);
ForeignSet ReadMaterialGanJson(const std::filesystem::path& file);
bool IsMaterialGanJson(const std::filesystem::path& file);  // by its fields
ForeignSet ReadDirSet(const std::filesystem::path& wlv_file);

// Throws UserError unless camera and light stand in front of the sample.
void RequireInFront(const std::filesystem::path& file, const std::string& field, const View& view);

}  // namespace glint
