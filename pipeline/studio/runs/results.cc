#include "pipeline/studio/runs/results.h"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>

#include "base/errors/errors.h"
#include "base/files/json_file.h"
#include "base/formats/manifest.h"
#include "pipeline/driver/ninja_file.h"
#include "pipeline/studio/captures/library.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

void AddFolder(const fs::path& folder, const std::string& prefix, int deep,
               std::map<std::string, fs::path>* files) {
  std::error_code error;
  if (fs::is_symlink(folder, error)) return;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename();
    if (entry.is_symlink(error) || name[0] == '.') continue;
    if (entry.is_directory(error) && deep > 0) {
      AddFolder(entry.path(), prefix + name + "/", deep - 1, files);
    } else if (entry.is_regular_file(error)) {
      files->emplace(prefix + name, entry.path());
    }
  }
}

// Where a report says that its figures come from.
void AddManifests(const fs::path& work, std::map<std::string, fs::path>* files) {
  std::error_code error;
  for (const auto& stage : fs::directory_iterator(work, error)) {
    const std::string name = stage.path().filename();
    if (name[0] == '.' || stage.is_symlink(error) || !stage.is_directory(error)) continue;
    const fs::path manifest = stage.path() / "manifest.json";
    if (fs::is_symlink(manifest, error) || !fs::is_regular_file(manifest, error)) continue;
    files->emplace(name + "/manifest.json", manifest);
  }
}

fs::path PreviousFolder(const fs::path& capture) { return StudioFolderOf(capture) / "previous"; }

std::string MeaningOf(const std::string& map) {
  static const std::map<std::string, std::string> meanings = {
      {"basecolor", "base colour: what a renderer with metalness multiplies the light by"},
      {"metallic", "metalness: 1 where the surface is bare metal"},
      {"roughness", "roughness: 0 a mirror, 1 matt"},
      {"normal_gl", "normals, green up (OpenGL: Blender, glTF, Unity)"},
      {"normal_dx", "normals, green down (DirectX: Unreal)"},
      {"height", "height of the relief"},
      {"ao", "ambient occlusion: how open each point is to its surroundings"},
      {"orm", "occlusion, roughness and metalness in one picture"},
      {"diffuse", "colour of the light that the surface scatters"},
      {"specular", "colour of the reflection seen straight on (F0)"},
      {"diffuse_layered", "diffuse colour for renderers that layer it under the reflection"},
      {"opacity", "opacity"}};
  const auto found = meanings.find(map);
  return found == meanings.end() ? map : found->second;
}

Json MapsJson(const Json& export_data, const std::string& base) {
  Json maps = Json::array();
  for (const Json& entry : export_data.value("maps", Json::array())) {
    const std::string name = entry.value("map", "");
    maps.push_back({{"name", name},
                    {"url", base + "export/" + entry.value("file", "")},
                    {"meaning", MeaningOf(name)}});
  }
  return maps;
}

Json PreviousJson(const fs::path& capture, const Json& maps, const std::string& base) {
  Json previous = Json::array();
  std::error_code error;
  for (const Json& map : maps) {
    const std::string file = fs::path(map["url"].get<std::string>()).filename();
    if (!fs::is_regular_file(PreviousFolder(capture) / file, error)) continue;
    Json one = map;
    one["url"] = base + "previous/" + file;
    previous.push_back(one);
  }
  if (previous.empty()) return nullptr;
  return {{"maps", previous}};
}

void AddFigure(const Json& manifest, const std::string& pointer, const std::string& name,
               double factor, const std::string& format, const std::string& meaning,
               Json* figures) {
  const Json::json_pointer at(pointer);
  if (!manifest.contains(at) || !manifest[at].is_number()) return;
  const double value = factor * manifest[at].get<double>();
  figures->push_back(
      {{"name", name}, {"value", fmt::format(fmt::runtime(format), value)}, {"meaning", meaning}});
}

// As the mean ratio of two brightnesses, of a mean difference of logarithms.
void AddRatio(const Json& manifest, const std::string& pointer, const std::string& name,
              const std::string& meaning, Json* figures) {
  const Json::json_pointer at(pointer);
  if (!manifest.contains(at) || !manifest[at].is_number()) return;
  figures->push_back({{"name", name},
                      {"value", fmt::format("× {:.2f}", std::exp(manifest[at].get<double>()))},
                      {"meaning", meaning}});
}

Json JsonOrNull(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return Json::object();
  try {
    return ReadJsonFile(file, "run it again");
  } catch (const Error&) {
    return Json::object();
  }
}

Json FiguresJson(const fs::path& work) {
  Json figures = Json::array();
  const Json calib = JsonOrNull(work / "calib" / "manifest.json");
  const Json report = JsonOrNull(work / "report" / "manifest.json");
  AddRatio(report, "/metrics/fitted/log_l1", "fitted photographs",
           "mean ratio of brightness between rendering and photograph; 1 is perfect", &figures);
  AddRatio(report, "/metrics/held_out/log_l1", "held-out photographs",
           "the same for photographs that the fit did not use", &figures);
  AddFigure(report, "/metrics/fitted/photographs", "photographs", 1, "{:.0f}",
            "that the maps were fitted to", &figures);
  AddFigure(report, "/metrics/fitted/ssim", "structure", 1, "{:.3f}",
            "structural similarity (SSIM) between rendering and photograph; 1 is identical",
            &figures);
  const Json::json_pointer corners("/metrics/corners");
  if (calib.contains(corners) && calib[corners] != 0) {  // without a board there are none
    AddFigure(
        calib, "/metrics/rms_px", "cameras", 1, "{:.2f} px",
        "distance between the board's corners and their positions predicted by the calibration",
        &figures);
  }
  AddFigure(calib, "/metrics/guidance/highlight_share", "highlights", 100, "{:.0f} %",
            "of the sample that shows a highlight in some photograph", &figures);
  return figures;
}

[[noreturn]] void ThrowZip(archive* zip, const char* what) {
  const std::string why = archive_error_string(zip) == nullptr ? what : archive_error_string(zip);
  archive_write_free(zip);
  throw HttpError{507, "the zip cannot be written: " + why, "make room on the disk"};
}

void AddToZip(archive* zip, const std::string& name, const fs::path& file) {
  const auto source = OpenToSend(file);
  if (!source) return;
  archive_entry* entry = archive_entry_new();
  archive_entry_set_pathname(entry, name.c_str());
  archive_entry_set_size(entry, static_cast<std::int64_t>(source->bytes()));
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_entry_set_perm(entry, 0644);
  const int begun = archive_write_header(zip, entry);
  archive_entry_free(entry);
  if (begun != ARCHIVE_OK) ThrowZip(zip, "header");
  constexpr std::size_t kPiece_bytes = 1 << 20;
  for (std::uint64_t at = 0; at < source->bytes();) {
    const std::string piece = source->Read(at, kPiece_bytes);
    if (piece.empty()) break;
    if (archive_write_data(zip, piece.data(), piece.size()) < 0) ThrowZip(zip, "data");
    at += piece.size();
  }
}

}  // namespace

std::shared_ptr<FileToSend> OpenToSend(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return nullptr;
  struct stat facts {};
  if (::fstat(descriptor, &facts) != 0 || !S_ISREG(facts.st_mode)) {
    ::close(descriptor);
    return nullptr;
  }
  return std::make_shared<FileToSend>(descriptor, static_cast<std::uint64_t>(facts.st_size));
}

std::string TypeOfFile(const std::string& name) {
  static const std::map<std::string, std::string> types = {{".html", "text/html; charset=utf-8"},
                                                           {".png", "image/png"},
                                                           {".jpg", "image/jpeg"},
                                                           {".svg", "image/svg+xml"},
                                                           {".glb", "model/gltf-binary"},
                                                           {".json", "application/json"},
                                                           {".pdf", "application/pdf"},
                                                           {".zip", "application/zip"},
                                                           {".txt", "text/plain; charset=utf-8"}};
  const auto found = types.find(fs::path(name).extension().string());
  return found == types.end() ? "application/octet-stream" : found->second;
}

std::map<std::string, fs::path> ResultFiles(const fs::path& capture) {
  std::map<std::string, fs::path> files;
  const fs::path work = capture / "glint";
  AddFolder(work / "report", "report/", 1, &files);
  AddFolder(work / "export", "export/", 2, &files);
  AddFolder(work / "tile", "tile/", 1, &files);
  AddFolder(PreviousFolder(capture), "previous/", 0, &files);
  AddManifests(work, &files);
  return files;
}

Json ResultJson(const fs::path& capture, const std::string& base) {
  const fs::path work = capture / "glint";
  std::error_code error;
  if (!fs::is_regular_file(work / "report" / "index.html", error)) return nullptr;
  const Json exported = JsonOrNull(work / "export" / "manifest.json");
  const Json data = exported.value("data", Json::object());
  bool quick = false;
  try {
    quick = ReadChoices(work / "build.ninja").method == "initial";
  } catch (const Error&) {
  }
  Json result = {{"quick", quick},
                 {"page", base + "report/index.html"},
                 {"tile", nullptr},
                 {"maps", MapsJson(data, base)},
                 {"figures", FiguresJson(work)},
                 {"zip", base + "export.zip"},
                 {"glb", nullptr},
                 {"previous", nullptr}};
  for (const Json& material : data.value("materials", Json::array())) {
    if (material.value("format", "") == "gltf") {
      result["glb"] = base + "export/" + material.value("file", "");
    }
  }
  if (data.value("repeats", false)) {
    for (const Json& map : result["maps"]) {
      if (map["name"] == "basecolor") result["tile"] = map["url"];
    }
  }
  result["previous"] = PreviousJson(capture, result["maps"], base);
  return result;
}

void KeepPreviousMaps(const fs::path& capture) {
  const fs::path to = PreviousFolder(capture);
  std::map<std::string, fs::path> files;
  AddFolder(capture / "glint" / "export", "", 2, &files);
  if (files.empty()) return;
  std::error_code error;
  fs::remove_all(to, error);
  fs::create_directories(to, error);
  for (const auto& [name, file] : files) {
    if (file.extension() != ".png") continue;
    fs::create_hard_link(file, to / file.filename(), error);
    if (error) fs::copy_file(file, to / file.filename(), error);
  }
}

std::shared_ptr<FileToSend> ZipOfExport(const fs::path& capture) {
  std::map<std::string, fs::path> files;
  AddFolder(capture / "glint" / "export", "", 2, &files);
  files.erase("manifest.json");
  files.erase("run.json");
  if (files.empty()) throw HttpError{404, "there is nothing to download yet", "run the capture"};
  const std::string folder = StudioFolderOf(capture).string();
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor < 0) {
    throw HttpError{507, std::string("the zip cannot be written: ") + std::strerror(errno),
                    "make room on the disk, and the capture's folder writable"};
  }
  archive* zip = archive_write_new();
  archive_write_set_format_zip(zip);
  archive_write_set_options(zip, "zip:compression=store");  // pictures are compressed already
  if (archive_write_open_fd(zip, descriptor) != ARCHIVE_OK) {
    ::close(descriptor);
    ThrowZip(zip, "open");
  }
  try {
    for (const auto& [name, file] : files) AddToZip(zip, name, file);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  if (archive_write_close(zip) != ARCHIVE_OK) {
    ::close(descriptor);
    ThrowZip(zip, "end");
  }
  archive_write_free(zip);
  struct stat facts {};
  ::fstat(descriptor, &facts);
  return std::make_shared<FileToSend>(descriptor, static_cast<std::uint64_t>(facts.st_size));
}

}  // namespace glint
