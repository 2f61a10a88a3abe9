#include "base/formats/rectified_set.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "base/errors/errors.h"
#include "base/formats/rectified_rows.h"
#include "base/model/photographs.h"
#include "base/photos/photo_name.h"
#include "base/stages/stages.h"

namespace glint {
namespace {

constexpr int kMaxSide_px = 16384;

Json FromVec(const Vec3d& vector) {
  return Json(std::vector<double>(vector.begin(), vector.end()));
}

Vec3d RequireVec(const std::filesystem::path& file, const Json& object, const std::string& name,
                 const std::string& field) {
  const std::vector<double> numbers = RequireNumbers(file, object, name, field, 3);
  return {numbers[0], numbers[1], numbers[2]};
}

int RequireSide(const std::filesystem::path& file, const Json& data, const std::string& field) {
  const double value = RequireNumber(file, data, "data", field);
  if (value < 1 || value > kMaxSide_px || value != std::floor(value)) {
    throw UserError(file, "data." + field, std::to_string(value),
                    "a whole number from 1 to " + std::to_string(kMaxSide_px) + " is expected");
  }
  return static_cast<int>(value);
}

RectifiedView ReadView(const std::filesystem::path& file, const Json& json, size_t index) {
  const std::string name = "data.views[" + std::to_string(index) + "]";
  RectifiedView view;
  view.name = RequireString(file, json, name, "name");
  view.file = RequireString(file, json, name, "file");
  view.photo = RequireString(file, json, name, "photo");
  view.ldr = RequireBool(file, json, name, "ldr");
  view.linear = json.contains("linear") && RequireBool(file, json, name, "linear");
  view.view.camera_in_sample_mm = RequireVec(file, json, name, "camera_in_sample_mm");
  view.view.light_in_sample_mm = RequireVec(file, json, name, "light_in_sample_mm");
  view.view.light_rgb = RequireVec(file, json, name, "light_rgb");
  view.view.ambient_rgb = RequireVec(file, json, name, "ambient_rgb");
  view.view.exposure = RequireNumber(file, json, name, "exposure");
  view.pixels_per_texel = PositiveNumberIfAny(file, json, name, "pixels_per_texel");
  view.blur_px = PositiveNumberIfAny(file, json, name, "blur_px");
  for (const auto& [field, z] :
       {std::pair<const char*, double>{"camera_in_sample_mm", view.view.camera_in_sample_mm[2]},
        {"light_in_sample_mm", view.view.light_in_sample_mm[2]}}) {
    if (z <= 0) {
      throw UserError(file, name + "." + field, "z = " + std::to_string(z),
                      "it must be in front of the sample (z > 0)");
    }
  }
  return view;
}

bool Names(const RectifiedView& view, const std::string& name) {
  return view.name == name || NamesPhoto(name, view.photo);
}

// Throws UserError for a name that no view has.
std::vector<std::string> KnownNames(const RectifiedSet& set,
                                    const std::vector<std::string>& parts) {
  const auto known = [&](const std::string& name) {
    return std::any_of(set.views.begin(), set.views.end(),
                       [&](const RectifiedView& view) { return Names(view, name); });
  };
  std::vector<std::string> names = RejoinedNames(parts, known);
  for (const std::string& name : names) {
    if (known(name)) continue;
    std::string list;
    for (const RectifiedView& view : set.views) {
      list += (list.empty() ? "" : ", ") + view.name + " (" + view.photo + ")";
    }
    throw UserError(set.manifest_file, "views", "no view named '" + name + "'",
                    "use a view's or photograph's name: " + list);
  }
  return names;
}

}  // namespace

std::string ViewName(size_t index) {
  char name[32];
  std::snprintf(name, sizeof(name), "view_%03zu", index);
  return name;
}

Json ToJson(const RectifiedSet& set) {
  Json data;
  data["width"] = set.plane.width;
  data["height"] = set.plane.height;
  data["width_mm"] = set.plane.width_mm;
  data["height_mm"] = set.plane.height_mm;
  data["convention"] = ToString(set.convention);
  data["light_power_known"] = set.light_power_known;
  if (set.fixed_camera) data["fixed_camera"] = true;
  if (set.light_sd_mm) data["light_sd_mm"] = *set.light_sd_mm;
  data["views"] = Json::array();
  for (const RectifiedView& view : set.views) {
    data["views"].push_back({{"name", view.name},
                             {"file", view.file},
                             {"photo", view.photo},
                             {"ldr", view.ldr},
                             {"camera_in_sample_mm", FromVec(view.view.camera_in_sample_mm)},
                             {"light_in_sample_mm", FromVec(view.view.light_in_sample_mm)},
                             {"light_rgb", FromVec(view.view.light_rgb)},
                             {"ambient_rgb", FromVec(view.view.ambient_rgb)},
                             {"exposure", view.view.exposure}});
    if (view.linear) data["views"].back()["linear"] = true;
    if (view.pixels_per_texel) {
      data["views"].back()["pixels_per_texel"] = *view.pixels_per_texel;
    }
    if (view.blur_px) data["views"].back()["blur_px"] = *view.blur_px;
  }
  return data;
}

std::filesystem::path ViewsManifest(const std::filesystem::path& work, std::string_view reader) {
  std::filesystem::path latest;
  for (const StageKind* stage = LastGiving(Gives::kViews, reader); stage != nullptr;
       stage = LastGiving(Gives::kViews, stage->name)) {
    std::filesystem::path file = work / stage->name / "manifest.json";
    std::error_code unreadable;  // whoever reads it will say so
    if (std::filesystem::exists(file, unreadable)) return file;
    if (latest.empty()) latest = std::move(file);
  }
  return latest;
}

std::filesystem::path ImportedViewsManifest(const std::filesystem::path& work) {
  return work / ImportedStage().name / "manifest.json";
}

RectifiedSet ReadRectifiedSet(const std::filesystem::path& manifest_file) {
  Manifest manifest = ReadManifest(manifest_file);
  const StageKind* stage = FindStage(manifest.stage);
  if (stage == nullptr || stage->gives != Gives::kViews) {
    manifest = ReadManifest(manifest_file, std::string(LastGiving(Gives::kViews)->name));
  }
  VerifyOutputs(manifest_file, manifest);
  const Json& data = manifest.data;
  RectifiedSet set;
  set.manifest_file = manifest_file;
  set.plane.width = RequireSide(manifest_file, data, "width");
  set.plane.height = RequireSide(manifest_file, data, "height");
  set.plane.width_mm = RequireNumber(manifest_file, data, "data", "width_mm");
  set.plane.height_mm = RequireNumber(manifest_file, data, "data", "height_mm");
  if (set.plane.width_mm <= 0 || set.plane.height_mm <= 0) {
    throw UserError(manifest_file, "data.width_mm, data.height_mm", "a size that is not positive",
                    "run rectify again");
  }
  const std::string convention = RequireString(manifest_file, data, "data", "convention");
  try {
    set.convention = ParseReflectanceConvention(convention);
  } catch (const std::invalid_argument& error) {
    throw UserError(manifest_file.string() + ": data.convention: " + error.what());
  }
  set.plane.sampling = set.convention.sampling;
  set.light_power_known = RequireBool(manifest_file, data, "data", "light_power_known");
  set.fixed_camera =
      data.contains("fixed_camera") && RequireBool(manifest_file, data, "data", "fixed_camera");
  set.light_sd_mm = PositiveNumberIfAny(manifest_file, data, "data", "light_sd_mm");
  const Json& views = RequireField(manifest_file, data, "data", "views");
  if (!views.is_array() || views.empty()) {
    throw UserError(manifest_file, "data.views", "no views", "run rectify again");
  }
  for (size_t i = 0; i < views.size(); ++i) {
    set.views.push_back(ReadView(manifest_file, views[i], i));
  }
  return set;
}

RectifiedImage ReadRectifiedImage(const RectifiedSet& set, const RectifiedView& view) {
  return RectifiedReader(set, view).Read(0, set.plane.height);
}

void AdmitClippedTexels(const RectifiedView& view, RectifiedImage* image) {
  if (!view.ldr) return;
  constexpr auto kClipped = static_cast<float>(constants::kClippedRadiance);
  const size_t texels = image->mask.size();
  for (size_t i = 0; i < texels; ++i) {
    const float brightest =
        std::max({image->rgb[i], image->rgb[texels + i], image->rgb[2 * texels + i]});
    if (brightest >= kClipped) image->mask[i] = 1.0f;
  }
}

void WriteRectifiedImage(const std::filesystem::path& file, const RectifiedImage& image,
                         const RectifiedSet& set, const RectifiedView& view) {
  RectifiedWriter writer(file, set, view);
  writer.Write(image);
  writer.Close();
}

std::vector<RectifiedView> SelectViews(const RectifiedSet& set,
                                       const std::vector<std::string>& only,
                                       const std::vector<std::string>& exclude) {
  const std::vector<std::string> chosen = KnownNames(set, only);
  const std::vector<std::string> excluded = KnownNames(set, exclude);
  const auto named = [](const RectifiedView& view, const std::vector<std::string>& names) {
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& name) { return Names(view, name); });
  };
  std::vector<RectifiedView> views;
  for (const RectifiedView& view : set.views) {
    if ((chosen.empty() || named(view, chosen)) && !named(view, excluded)) views.push_back(view);
  }
  if (views.empty()) {
    throw UserError(set.manifest_file, "views", "no view left after --views and --exclude",
                    "keep at least one");
  }
  return views;
}

}  // namespace glint
