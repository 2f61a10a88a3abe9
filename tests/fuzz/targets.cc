#include "tests/fuzz/targets.h"

#include <fstream>
#include <stdexcept>

#include "base/errors/errors.h"
#include "base/files/hash_cache.h"
#include "base/formats/board_file.h"
#include "base/formats/calibration.h"
#include "base/formats/capture.h"
#include "base/formats/manifest.h"
#include "base/formats/rectified_set.h"
#include "base/formats/svbrdf_file.h"
#include "base/linearize/response_curve.h"
#include "base/photos/photo.h"
#include "calib/chart/chart.h"
#include "calib/colmap/colmap_model.h"
#include "calib/moving_light/lights_file.h"
#include "datasets/import/foreign_set.h"
#include "fitting/weights/safetensors.h"
#include "tests/fuzz/studio_client.h"

namespace glint::fuzz {
namespace {

namespace fs = std::filesystem;

// Of rectified images as a corpus holds them.
constexpr int kRectifiedSize = 8;

// A request takes some milliseconds.
constexpr int kStudioReplays = 10;

fs::path Put(const fs::path& folder, const std::string& name, std::string_view bytes) {
  fs::path file = folder / name;
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

FuzzTarget OfFile(const std::string& name, const std::string& file_name,
                  const std::function<void(const fs::path&)>& read) {
  return {name, [file_name, read](const fs::path& folder, std::string_view bytes) {
            read(Put(folder, file_name, bytes));
          }};
}

void ReadRectified(const fs::path& file) {
  RectifiedSet set;
  set.manifest_file = file.parent_path() / "manifest.json";
  set.plane.width = set.plane.height = kRectifiedSize;
  RectifiedView view;
  view.file = file.filename();
  ReadRectifiedImage(set, view);
}

// Directions, or positions where the file says how large the picture is.
void ReadLights(const fs::path& file) {
  constexpr double kPictureWidth_mm = 100;
  const LightsFile read = ReadLightsFile(file, "", kPictureWidth_mm);
  std::vector<std::string> photos, remarks;
  for (const ListedLight& light : read.lights) photos.push_back("photos/" + light.photo);
  MatchLights(read, photos, &remarks);
}

// Stands below the contract, whose errors it does not know.
void ReadTensors(const fs::path& file) {
  try {
    ReadTensorFile(file);
  } catch (const std::runtime_error& error) {
    throw UserError(error.what());
  }
}

// The three files of a model one after the other, each behind a line "== NAME".
void ReadColmap(const fs::path& folder, std::string_view bytes) {
  for (const char* name : {"cameras", "images", "points3D"}) {
    for (const char* extension : {".txt", ".bin"}) {
      std::error_code none;
      fs::remove(folder / (std::string(name) + extension), none);
      const std::string line = std::string("== ") + name + extension + "\n";
      const size_t begin = bytes.find(line);
      if (begin == std::string_view::npos) continue;
      const std::string_view rest = bytes.substr(begin + line.size());
      Put(folder, std::string(name) + extension, rest.substr(0, rest.find("\n== ")));
    }
  }
  ReadColmapModel(folder);
}

}  // namespace

const std::vector<FuzzTarget>& FuzzTargets() {
  static const std::vector<FuzzTarget> targets = {
      {"capture_toml",
       [](const fs::path& folder, std::string_view bytes) {
         Put(folder, "a.jpg", "");
         Put(folder, "capture.toml", bytes);
         ReadCapture(folder);
       }},
      OfFile("board", "board.json", [](const fs::path& file) { ReadBoardFile(file); }),
      OfFile("manifest", "manifest.json", [](const fs::path& file) { ReadManifest(file); }),
      OfFile("calibration", "manifest.json", [](const fs::path& file) { ReadCalibration(file); }),
      OfFile("rectified_set", "manifest.json",
             [](const fs::path& file) { ReadRectifiedSet(file); }),
      OfFile("rectified_image", "view.exr", ReadRectified),
      OfFile("svbrdf", "svbrdf.exr", [](const fs::path& file) { ReadSvbrdf(file); }),
      OfFile("photo_header", "photo.jpg", [](const fs::path& file) { PhotoSize(file); }),
      OfFile("views", "views.json", [](const fs::path& file) { ReadViewsJson(file); }),
      OfFile("response", "response.json", [](const fs::path& file) { ReadResponseCurve(file); }),
      OfFile("safetensors", "weights.safetensors", ReadTensors),
      OfFile("chart_csv", "chart.csv", [](const fs::path& file) { ReadChartCsv(file, "A", 1.5); }),
      OfFile("lights_lp", "dirs.lp", ReadLights),
      OfFile("lights_relight", "coin.relight", ReadLights),
      OfFile("lights_dome", "lamps.dome", ReadLights),
      OfFile("hash_cache", "hashes.json", [](const fs::path& file) { HashCache{file}; }),
      {"colmap", ReadColmap},
      {"studio", [](const fs::path&, std::string_view bytes) { SendToStudio(bytes); },
       kStudioReplays},
  };
  return targets;
}

const FuzzTarget& FindFuzzTarget(const std::string& name) {
  for (const FuzzTarget& target : FuzzTargets()) {
    if (target.name == name) return target;
  }
  throw std::out_of_range("no such fuzz target: " + name);
}

bool Accepts(const FuzzTarget& target, const fs::path& folder, std::string_view bytes) {
  try {
    target.read(folder, bytes);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace glint::fuzz
