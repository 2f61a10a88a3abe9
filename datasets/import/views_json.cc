// views.json: see docs/views.md.
#include <set>
#include <stdexcept>

#include "base/errors/errors.h"
#include "base/linearize/encoding.h"
#include "datasets/import/foreign_set.h"
#include "datasets/import/json_fields.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kVersion = 1;
constexpr size_t kMaxViews = 10000;

Vec3d Vec(const std::vector<double>& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

// "estimate" (nullopt), a number or [r, g, b].
std::optional<Vec3d> LightPower(JsonFields* fields, const Json& value) {
  if (value.is_string() && value.get<std::string>() == "estimate") return std::nullopt;
  if (value.is_string()) {
    fields->Reject(fields->Path("light_power"), value, "use \"estimate\", a number or [r, g, b]");
  }
  return Vec(fields->Numbers("light_power", value, 3, true, 0));
}

ForeignView ReadView(const fs::path& file, const Json& json, size_t index, const View& common) {
  JsonFields fields(file, json, "views[" + std::to_string(index) + "]");
  ForeignView view;
  view.view = common;
  fields.Require("image", "name the image's file, relative to views.json");
  view.name = fields.Text("image", "");
  view.image = file.parent_path() / view.name;
  const Json& camera = fields.Require("camera_in_sample_mm", "give [x, y, z] of the camera");
  view.view.camera_in_sample_mm = view.view.light_in_sample_mm =
      Vec(fields.Numbers("camera_in_sample_mm", camera, 3, false, JsonFields::kAny));
  if (const Json* light = fields.Find("light_in_sample_mm")) {
    view.view.light_in_sample_mm =
        Vec(fields.Numbers("light_in_sample_mm", *light, 3, false, JsonFields::kAny));
  }
  if (const Json* power = fields.Find("light_power")) {
    view.view.light_rgb = Vec(fields.Numbers("light_power", *power, 3, true, 0));
  }
  if (const Json* ambient = fields.Find("ambient")) {
    view.view.ambient_rgb = Vec(fields.Numbers("ambient", *ambient, 3, true, 0));
  }
  if (const Json* exposure = fields.Find("exposure")) {
    if (!exposure->is_number() || !(exposure->get<double>() > 0)) {
      fields.Reject(fields.Path("exposure"), *exposure, "a number above 0 is expected");
    }
    view.view.exposure = exposure->get<double>();
  }
  if (const Json* ldr = fields.Find("ldr")) {
    if (!ldr->is_boolean()) fields.Reject(fields.Path("ldr"), *ldr, "true or false is expected");
    view.ldr = ldr->get<bool>();
  }
  fields.RejectUnknown();
  RequireInFront(file, "views[" + std::to_string(index) + "]", view.view);
  return view;
}

void ReadSetFields(const fs::path& file, JsonFields* fields, ForeignSet* set) {
  const Json& version = fields->Require("glint_views", "write \"glint_views\": 1");
  if (version != kVersion) fields->Reject("glint_views", version, "this program reads version 1");
  const Json& size = fields->Require("size_mm", "give [width, height] of what the images show");
  const auto sides = fields->Numbers("size_mm", size, 2, false, 0);
  if (!(sides[0] > 0 && sides[1] > 0)) {
    fields->Reject("size_mm", size, "give a width and height above 0");
  }
  set->width_mm = sides[0];
  set->height_mm = sides[1];
  set->encoding = fields->Text("encoding", "auto");
  if (set->encoding != "auto" && !EncodingFromName(set->encoding)) {
    throw UserError(file, "encoding", "'" + set->encoding + "'",
                    "use auto, srgb, gamma2.2 or linear");
  }
  try {
    set->convention = ParseReflectanceConvention(fields->Text("convention", "photograph"));
  } catch (const std::invalid_argument& error) {
    throw UserError(file.string() + ": " + error.what());
  }
}

}  // namespace

ForeignSet ReadViewsJson(const fs::path& file) {
  const Json json = ReadJsonFile(file, "see docs/views.md for the format");
  JsonFields fields(file, json, "");
  ForeignSet set;
  set.layout = ForeignLayout::kViewsJson;
  set.description = {file};
  ReadSetFields(file, &fields, &set);
  View common;
  const Json& power = fields.Require("light_power", "use \"estimate\", a number or [r, g, b]");
  const std::optional<Vec3d> known = LightPower(&fields, power);
  set.light_power_known = set.light_power_given = known.has_value();
  if (known) common.light_rgb = *known;
  if (const Json* ambient = fields.Find("ambient")) {
    common.ambient_rgb = Vec(fields.Numbers("ambient", *ambient, 3, true, 0));
  }
  if (const Json* plane = fields.Find("plane_mm")) {
    if (!plane->is_number()) fields.Reject("plane_mm", *plane, "a number is expected");
    set.plane_mm = plane->get<double>();
  }
  const Json& views = fields.Require("views", "give a list with an object for each image");
  if (!views.is_array() || views.empty() || views.size() > kMaxViews) {
    fields.Reject("views", views, "a list of 1 to 10000 objects is expected");
  }
  fields.RejectUnknown();
  std::set<std::string> names;
  for (size_t i = 0; i < views.size(); ++i) {
    set.views.push_back(ReadView(file, views[i], i, common));
    if (!known && views[i].contains("light_power")) {
      throw UserError(file, "views[" + std::to_string(i) + "].light_power",
                      ShownJson(views[i]["light_power"]),
                      "with \"light_power\": \"estimate\" for all, differences between views go "
                      "into their exposure");
    }
    if (!names.insert(set.views.back().name).second) {
      throw UserError(file, "views[" + std::to_string(i) + "].image",
                      "'" + set.views.back().name + "' a second time", "name each image once");
    }
  }
  return set;
}

}  // namespace glint
