// Projects and domes of RelightLab (github.com/cnr-isti-vclab/relight, relightlab/docs/formats). A
// dome's lamps are directions, points of a sphere, or positions; lengths count by the width of the
// picture that the file tells.
#include <fmt/format.h>

#include "base/errors/errors.h"
#include "base/files/json_file.h"
#include "base/files/json_object.h"
#include "calib/moving_light/lights_file_formats.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

double NumberOr(const Json& json, const char* key, double fallback) {
  const auto at = json.find(key);
  return at != json.end() && at->is_number() ? at->get<double>() : fallback;
}

// {"x": …, "y": …, "z": …} or [x, y, z].
Eigen::Vector3d VectorOf(const fs::path& file, const std::string& place, const Json& json) {
  Eigen::Vector3d vector;
  const char* keys[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    const Json* value = nullptr;
    if (json.is_object() && json.contains(keys[i])) value = &json[keys[i]];
    if (json.is_array() && json.size() == 3) value = &json[static_cast<size_t>(i)];
    if (value == nullptr || !value->is_number()) {
      throw UserError(file, place, Describe(json), "a vector of x, y and z is expected");
    }
    vector[i] = value->get<double>();
  }
  return vector;
}

struct DomeGeometry {
  std::string configuration = "directional";  // or spherical, lights3d
  double diameter = 0, offset = 0, picture_width = 0;

  explicit DomeGeometry(const Json& json) {
    if (json.contains("lightConfiguration") && json["lightConfiguration"].is_string()) {
      configuration = json["lightConfiguration"].get<std::string>();
    }
    diameter = NumberOr(json, "domeDiameter", NumberOr(json, "diameter", 0));
    offset = NumberOr(json, "verticalOffset", 0);
    picture_width = NumberOr(json, "imageWidth", 0);
  }
  // Millimetres of a unit of the file's lengths; 0: nothing tells.
  double Unit_mm(double picture_width_mm) const {
    return picture_width > 0 ? picture_width_mm / picture_width : 0;
  }
  // The light of a lamp known by its direction.
  ListedLight Lamp(const fs::path& file, const std::string& place, const Eigen::Vector3d& direction,
                   double unit_mm) const {
    ListedLight far = LightOf(file, place, direction, 0);
    if (configuration != "spherical" || !(diameter > 0) || !(unit_mm > 0)) return far;
    return LightOf(file, place, diameter / 2 * far.direction + Eigen::Vector3d(0, 0, offset),
                   unit_mm);
  }
};

const Json* ListIn(const Json& json, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    const auto at = json.find(key);
    if (at != json.end() && at->is_array() && !at->empty()) return &*at;
  }
  return nullptr;
}

std::vector<ListedLight> LampsOf(const fs::path& file, const Json& dome, double picture_width_mm) {
  const DomeGeometry geometry(dome);
  const double unit_mm = geometry.Unit_mm(picture_width_mm);
  const bool placed = geometry.configuration == "lights3d" && unit_mm > 0;
  const Json* list = placed ? ListIn(dome, {"positions3d", "positions"}) : nullptr;
  const bool positions = list != nullptr;
  if (!positions) list = ListIn(dome, {"directions", "positions3d", "positions"});
  if (list == nullptr) return {};
  std::vector<ListedLight> lamps;
  for (size_t i = 0; i < list->size(); ++i) {
    const std::string place = fmt::format("light {}", i + 1);
    const Eigen::Vector3d vector = VectorOf(file, place, (*list)[i]);
    lamps.push_back(positions ? LightOf(file, place, vector, unit_mm)
                              : geometry.Lamp(file, place, vector.normalized(), unit_mm));
  }
  return lamps;
}

// A project's images that are not skipped, and their lights: their own, or the dome's.
std::vector<ListedLight> ImagesOf(const fs::path& file, const Json& project,
                                  double picture_width_mm) {
  const Json none = Json::object();
  const Json& dome = project.contains("dome") ? project["dome"] : none;
  const std::vector<ListedLight> lamps = LampsOf(file, dome, picture_width_mm);
  const Json& images = project["images"];
  std::vector<ListedLight> lights;
  for (size_t i = 0; i < images.size(); ++i) {
    const Json& image = images[i];
    const std::string place = fmt::format("images[{}]", i);
    if (!image.is_object() || !image.contains("filename") || !image["filename"].is_string()) {
      throw UserError(file, place + ".filename", Describe(image), "a file name is expected");
    }
    if (image.contains("skip") && image["skip"].is_boolean() && image["skip"].get<bool>()) continue;
    ListedLight light;
    if (i < lamps.size()) {
      light = lamps[i];
    } else if (image.contains("direction")) {
      const Eigen::Vector3d vector = VectorOf(file, place + ".direction", image["direction"]);
      light = LightOf(file, place + ".direction", vector, 0);
    } else {
      throw UserError(file, place, "no direction",
                      "find the lights in RelightLab first, or give an .lp file");
    }
    light.photo = WithoutFolders(image["filename"].get<std::string>());
    lights.push_back(light);
  }
  return lights;
}

}  // namespace

LightsFile ReadRelightFile(const fs::path& file, double picture_width_mm) {
  const Json json = ReadJsonFile(file, "save it again in RelightLab, or give an .lp file");
  LightsFile result;
  result.file = file;
  if (json.is_object() && ListIn(json, {"images"}) != nullptr) {
    result.lights = ImagesOf(file, json, picture_width_mm);
  } else if (json.is_object()) {
    result.lights = LampsOf(file, json, picture_width_mm);
  }
  return result;
}

}  // namespace glint
