// The layouts of MaterialGAN (Guo et al. 2020) and of its successor svbrdf-diff-renderer. Both give
// centimetres, in Glint's sample frame (x right, y up in the image, z toward the camera),
// gamma 2.2, E = P/d² and a diffuse lobe weighted by 1 − k_s. Their light power (cm²) is a setting
// of the program and not a measurement, so it enters as a first guess.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <utility>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/photos/photo.h"
#include "datasets/import/foreign_set.h"
#include "datasets/import/json_fields.h"
#include "datasets/import/number_file.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr double kMillimetres = 10;         // a centimetre
constexpr double kSquareMillimetres = 100;  // a square centimetre
// Frames of 1600² pixels show the markers too; the sample is their central 1024².
constexpr int kFrame_px = 1600, kFrameSample_px = 1024;

Vec3d Millimetres(const std::vector<double>& cm) {
  return {cm[0] * kMillimetres, cm[1] * kMillimetres, cm[2] * kMillimetres};
}

Vec3d Power(const std::vector<double>& cm2) {
  return {cm2[0] * kSquareMillimetres, cm2[1] * kSquareMillimetres, cm2[2] * kSquareMillimetres};
}

ForeignSet EmptySet(ForeignLayout layout) {
  ForeignSet set;
  set.layout = layout;
  set.encoding = "gamma2.2";
  set.convention = ReflectanceConvention::MaterialGan();
  set.light_power_known = false;
  return set;
}

void SetSize(const fs::path& file, const std::string& field, double cm, ForeignSet* set) {
  if (!(cm > 0)) throw UserError(file, field, std::to_string(cm), "give the side in centimetres");
  set->width_mm = set->height_mm = cm * kMillimetres;
}

std::string TwoDigits(int index) {
  char text[16];
  std::snprintf(text, sizeof(text), "%02d", index);
  return text;
}

// Images whose stem ends in a number of two digits, by that number.
std::vector<fs::path> NumberedImages(const fs::path& folder) {
  std::vector<fs::path> images;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string ending = entry.path().extension(), stem = entry.path().stem();
    const bool numbered = stem.size() >= 2 &&
                          std::isdigit(static_cast<unsigned char>(stem.back())) &&
                          std::isdigit(static_cast<unsigned char>(stem[stem.size() - 2]));
    const bool image = ending == ".png" || ending == ".jpg" || ending == ".exr" || ending == ".tif";
    if (entry.is_regular_file() && numbered && image) images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  return images;
}

// The image numbered `index`; empty: none.
fs::path ImageOf(const std::vector<fs::path>& images, int index) {
  for (const fs::path& image : images) {
    const std::string stem = image.stem();
    const size_t digits = stem.find_last_not_of("0123456789") + 1;  // npos + 1 is 0
    if (stem.substr(digits) == TwoDigits(index)) return image;
  }
  return {};
}

// The images lie beside the file, or where it says.
std::vector<fs::path> ImagesOf(const fs::path& folder, const Json* images_dir) {
  std::vector<fs::path> beside = NumberedImages(folder);
  if (!beside.empty() || images_dir == nullptr || !images_dir->is_string()) return beside;
  const fs::path inside = folder / images_dir->get<std::string>();
  return fs::is_directory(inside) ? NumberedImages(inside) : beside;
}

// Of two names for the same, by the program's version.
const Json* EitherOf(const char* newer, const char* older, JsonFields* fields) {
  const Json* found = fields->Find(newer);
  return found != nullptr ? found : fields->Find(older);
}

}  // namespace

ForeignSet ReadMaterialGanText(const fs::path& folder) {
  ForeignSet set = EmptySet(ForeignLayout::kMaterialGanText);
  const fs::path cameras_file = folder / "camera_pos.txt", lights_file = folder / "light_pos.txt";
  const fs::path size_file = folder / "image_size.txt", power_file = folder / "light_power.txt";
  set.description = {cameras_file, lights_file, size_file, power_file};
  const auto cameras = ReadNumberRows(cameras_file, 3), lights = ReadNumberRows(lights_file, 3);
  SetSize(size_file, "", ReadNumberRows(size_file, 1)[0].numbers[0], &set);
  const Vec3d power = Power(ReadNumberRows(power_file, 3)[0].numbers);
  if (cameras.size() != lights.size()) {
    throw UserError(lights_file, "", std::to_string(lights.size()) + " positions",
                    "camera_pos.txt has " + std::to_string(cameras.size()) + "; give one per view");
  }
  const auto images = NumberedImages(folder);
  if (images.size() != cameras.size()) {
    throw UserError(folder, "images", std::to_string(images.size()) + " images (00.png …)",
                    "camera_pos.txt has " + std::to_string(cameras.size()) +
                        " positions; give one image per position");
  }
  for (size_t i = 0; i < cameras.size(); ++i) {
    ForeignView view;
    view.image = images[i];
    view.name = images[i].filename();
    view.view.camera_in_sample_mm = Millimetres(cameras[i].numbers);
    view.view.light_in_sample_mm = Millimetres(lights[i].numbers);
    view.view.light_rgb = power;
    RequireInFront(cameras_file, "line " + std::to_string(cameras[i].line), view.view);
    set.views.push_back(view);
  }
  return set;
}

bool IsMaterialGanJson(const fs::path& file) {
  if (file.extension() != ".json" || !fs::is_regular_file(file)) return false;
  constexpr std::size_t kMostBytes = 16u << 20;
  if (fs::file_size(file) > kMostBytes) return false;
  const Json json = Json::parse(ReadTextFile(file, kMostBytes), nullptr, false);
  return json.is_object() && json.contains("idx") && json.contains("camera_pos") &&
         json.contains("light_pos");
}

ForeignSet ReadMaterialGanJson(const fs::path& file) {
  ForeignSet set = EmptySet(ForeignLayout::kMaterialGanJson);
  const fs::path folder = fs::absolute(file).parent_path();
  set.description = {file};
  const Json json = ReadJsonFile(file, "copy the file again");
  JsonFields fields(file, json, "");
  const std::string remedy = "give im_size, idx, camera_pos, light_pos and light_pow";
  const Json* size = EitherOf("im_size", "image_size", &fields);
  if (size == nullptr) size = &fields.Require("im_size", remedy);
  SetSize(file, "im_size", fields.Numbers("im_size", *size, 1, true, 0)[0], &set);
  const Vec3d power =
      Power(fields.Numbers("light_pow", fields.Require("light_pow", remedy), 3, true, 0));
  const Json& indices = fields.Require("idx", remedy);
  const Json& cameras = fields.Require("camera_pos", remedy);
  const Json& lights = fields.Require("light_pos", remedy);
  if (!indices.is_array() || indices.empty()) fields.Reject("idx", indices, "give a list");
  for (const auto& [field, list] : {std::pair{"camera_pos", &cameras}, {"light_pos", &lights}}) {
    if (list->is_array() && list->size() == indices.size()) continue;
    fields.Reject(
        field, *list,
        "give one position for each of the " + std::to_string(indices.size()) + " entries of idx");
  }
  const std::vector<fs::path> images =
      ImagesOf(folder, EitherOf("target_dir", "images_dir", &fields));
  for (size_t i = 0; i < indices.size(); ++i) {
    const std::string at = "[" + std::to_string(i) + "]";
    if (!indices[i].is_number_integer()) {
      fields.Reject("idx" + at, indices[i], "a whole number is expected");
    }
    ForeignView view;
    view.image = ImageOf(images, indices[i].get<int>());
    // Positions go by number here, so that a set can be used in part.
    if (view.image.empty()) {
      spdlog::warn("{}: idx{}: no image numbered {}; left out", file.string(), at,
                   TwoDigits(indices[i].get<int>()));
      continue;
    }
    view.name = view.image.filename();
    view.view.camera_in_sample_mm =
        Millimetres(fields.Numbers("camera_pos" + at, cameras[i], 3, false, JsonFields::kAny));
    view.view.light_in_sample_mm =
        Millimetres(fields.Numbers("light_pos" + at, lights[i], 3, false, JsonFields::kAny));
    view.view.light_rgb = power;
    std::string positions = "camera_pos";
    positions.append(at).append(", light_pos").append(at);
    RequireInFront(file, positions, view.view);
    set.views.push_back(view);
  }
  if (set.views.empty()) {
    throw UserError(folder, "images", "no image numbered as idx says",
                    "put the rectified images (00.png …) beside " + file.filename().string());
  }
  if (PhotoSize(set.views[0].image).first == kFrame_px) set.crop_px = kFrameSample_px;
  return set;
}

}  // namespace glint
