#include "calib/triage/list_photos.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors/errors.h"
#include "base/images/image_format.h"
#include "base/photos/photo_name.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMost = 10000;

std::vector<fs::path> FindPhotos(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw UserError(folder, "", "no such folder", "give a folder of photographs");
  }
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    const std::string name = at->path().filename();
    if (name == "glint" && at->is_directory()) at.disable_recursion_pending();
    if (name[0] == '.' || !at->is_regular_file() ||
        !(IsPhotoFileName(at->path()) || IsVideoFileName(at->path()))) {
      continue;
    }
    files.push_back(at->path());
    if (files.size() < kMost) continue;
    throw UserError(folder, "", "more than " + std::to_string(kMost) + " photographs",
                    "give a folder with fewer");
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) {
    throw UserError(folder, "", "no photographs", "give a folder with JPEG, HEIC, RAW… files");
  }
  return files;
}

ListedPhoto ListOne(const fs::path& folder, const fs::path& file) {
  ListedPhoto listed;
  listed.name = file.lexically_relative(folder).generic_string();
  try {
    const Photo photo =
        ReadPhoto(IsVideoFileName(file) ? fs::path(FrameName(file.string(), 0)) : file);
    listed.measures = MeasurePhoto(listed.name, photo, GrayFromPhoto(photo), {});
    listed.measures.flash_photo = false;  // whether it should be one is not known
  } catch (const Error& error) {
    listed.problem = error.what();
    // The folder is known; its place does not belong into a table.
    const std::string prefix = file.string() + ": ";
    if (listed.problem.rfind(prefix, 0) == 0) listed.problem.erase(0, prefix.size());
  }
  return listed;
}

std::string TimeText(double seconds) {
  if (seconds <= 0) return "–";
  return seconds < 0.3 ? fmt::format("1/{:.0f} s", 1 / seconds) : fmt::format("{:g} s", seconds);
}

std::string NumberText(double value, const char* before, const char* after) {
  return value > 0 ? fmt::format("{}{:.4g}{}", before, value, after) : "–";
}

std::string Row(const ListedPhoto& photo) {
  if (!photo.problem.empty()) {
    return fmt::format("| {} | | | | | | | | cannot be read: {} |\n", photo.name, photo.problem);
  }
  const Photo& f = photo.measures.file;
  std::string remarks;
  for (const std::string& remark : OwnRemarks(photo)) {
    remarks += (remarks.empty() ? "" : "; ") + remark;
  }
  return fmt::format(
      "| {} | {}x{} | {} {} bit | {} | {} | {} | {} ({}) | {}, {}, {} | {} |\n", photo.name,
      f.image.width, f.image.height, f.format, f.bits, f.colour.Description(), f.orientation,
      f.camera_model.empty() ? "–" : f.camera_model, NumberText(f.exif.focal_length_mm, "", " mm"),
      NumberText(f.focal_length_35mm, "", " mm"), TimeText(f.exposure_time_s),
      NumberText(f.iso, "ISO ", ""), NumberText(f.f_number, "f/", ""), remarks);
}

}  // namespace

std::vector<ListedPhoto> ListPhotos(const fs::path& folder) {
  std::vector<ListedPhoto> photos;
  for (const fs::path& file : FindPhotos(folder)) photos.push_back(ListOne(folder, file));
  return photos;
}

std::vector<std::string> OwnRemarks(const ListedPhoto& photo) {
  std::vector<std::string> texts;
  for (const Remark& remark : CheckExif({photo.measures})) texts.push_back(remark.text);
  const Photo& f = photo.measures.file;
  if (f.exposure() == 0) texts.emplace_back("EXIF reports no exposure");
  return texts;
}

std::string TableOf(const std::vector<ListedPhoto>& photos) {
  std::string table =
      "| file | pixels | format | colours | orientation | camera | focal length (35 mm) | exposure "
      "| remarks "
      "|\n|---|---|---|---|---|---|---|---|---|\n";
  for (const ListedPhoto& photo : photos) table += Row(photo);
  return table;
}

Json ToJson(const std::vector<ListedPhoto>& photos) {
  Json json = Json::array();
  for (const ListedPhoto& photo : photos) {
    Json entry = {{"photo", photo.name}};
    if (!photo.problem.empty()) {
      entry["problem"] = photo.problem;
    } else {
      entry.update(ToJson(photo.measures));
      entry["remarks"] = OwnRemarks(photo);
    }
    json.push_back(entry);
  }
  return json;
}

}  // namespace glint
