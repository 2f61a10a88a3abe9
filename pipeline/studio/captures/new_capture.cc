#include "pipeline/studio/captures/new_capture.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>

#include <cerrno>
#include <cmath>
#include <cstring>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/json_file.h"
#include "pipeline/driver/init.h"
#include "pipeline/studio/access/token.h"
#include "pipeline/studio/captures/library.h"
#include "pipeline/studio/captures/toml_edit.h"
#include "pipeline/studio/http/http_types.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

std::string FolderName(const std::string& name) {
  constexpr size_t kMost = 100;
  std::string plain = FileNameOf(name).substr(0, kMost);
  if (name.find_first_not_of(" ._-/\\") == std::string::npos) {
    throw HttpError{422, "the capture has no name", "give it one, such as wood"};
  }
  return plain;
}

InitOptions InitOptionsOf(const NewCapture& wanted, const fs::path& folder) {
  InitOptions options;
  options.folder = folder;
  if (wanted.size_mm) options.sample_mm = {(*wanted.size_mm)[0], (*wanted.size_mm)[1]};
  options.single = wanted.kind == "single";
  options.width_mm = wanted.picture_width_mm;
  options.distance_mm = wanted.distance_mm;
  return options;
}

Json DraftJson(const NewCapture& wanted) {
  Json json = {{"kind", wanted.kind},
               {"size_mm", nullptr},
               {"picture_width_mm", wanted.picture_width_mm},
               {"distance_mm", wanted.distance_mm}};
  if (wanted.size_mm) json["size_mm"] = *wanted.size_mm;
  return json;
}

// In a folder that nobody sees yet.
void Fill(const NewCapture& wanted, const std::string& name, const fs::path& folder) {
  fs::create_directories(folder / "photos");
  if (wanted.kind == "single") {
    WriteFileAtomically(folder / kDraftFile, DraftJson(wanted).dump(1) + "\n");
    return;
  }
  WriteFileAtomically(folder / "board.json", BoardText(*wanted.board));
  const fs::path file = WriteCapture(InitOptionsOf(wanted, folder)).file;
  std::string text = ReadTextFile(file);
  // The folder's name is not yet the one that glint init would see.
  text = WithTomlValue(file, text, "export", "name", Json(name));
  text = WithTomlValue(file, text, "sample", "height_mm",
                       wanted.height_mm ? Json(*wanted.height_mm) : Json("auto"));
  WriteFileAtomically(file, text);
}

}  // namespace

fs::path MakeCapture(const fs::path& root, const NewCapture& wanted) {
  if (wanted.kind == "rectified") {
    throw HttpError{422,
                    "photographs that another program has rectified need their cameras as well",
                    "import them with glint import; the capture then appears here"};
  }
  if (wanted.kind != "board" && wanted.kind != "single") {
    throw HttpError{422, "found the unknown kind '" + wanted.kind + "'", "choose board or single"};
  }
  if (wanted.size_mm) RequireSampleSize(*wanted.size_mm);
  if (wanted.kind == "board") {
    if (!wanted.board) throw HttpError{422, "no board is chosen", "choose or print one"};
    if (wanted.size_mm) RequireRoomFor(*wanted.size_mm, wanted.board->file.board);
  } else if ((wanted.picture_width_mm > 0) == (wanted.distance_mm > 0)) {
    throw HttpError{422, "the scale of the one photograph is not known",
                    "give the width that the picture shows, or the lens's distance"};
  }
  if (wanted.kind == "single" && wanted.distance_mm > 0 && !wanted.size_mm) {
    throw HttpError{422, "the sample's size is not known", "give its width and height"};
  }
  const std::string name = FolderName(wanted.name);
  const fs::path hidden = root / kStudioFolder / ("new-" + RandomToken()) / name;
  std::error_code error;
  try {
    Fill(wanted, name, hidden);
    fs::path folder = root / name;
    if (::renameat2(AT_FDCWD, hidden.c_str(), AT_FDCWD, folder.c_str(), RENAME_NOREPLACE) == 0) {
      fs::remove(hidden.parent_path(), error);
      return folder;
    }
    if (errno == EEXIST) {
      throw HttpError{409, "there is a folder " + name + " already", "give another name"};
    }
    throw EnvironmentError(folder.string() + ": cannot be made: " + std::strerror(errno));
  } catch (...) {
    fs::remove_all(hidden.parent_path(), error);
    throw;
  }
}

bool IsDraft(const fs::path& capture) {
  std::error_code error;
  return !fs::exists(capture / "capture.toml", error) &&
         fs::is_regular_file(capture / kDraftFile, error);
}

NewCapture ReadDraft(const fs::path& capture) {
  const fs::path file = capture / kDraftFile;
  const Json json = ReadJsonFile(file, "make the capture again");
  try {
    NewCapture draft;
    draft.kind = json.at("kind").get<std::string>();
    draft.picture_width_mm = json.value("picture_width_mm", 0.0);
    draft.distance_mm = json.value("distance_mm", 0.0);
    if (json.contains("size_mm") && !json["size_mm"].is_null()) {
      draft.size_mm = json["size_mm"].get<std::array<double, 2>>();
    }
    return draft;
  } catch (const nlohmann::json::exception&) {
    throw UserError(file, "", "something other than a draft", "make the capture again");
  }
}

void FinishDraft(const fs::path& capture) {
  if (!IsDraft(capture)) return;
  size_t photographs = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(capture / "photos", error)) {
    if (entry.path().filename().string()[0] != '.' && entry.is_regular_file(error)) ++photographs;
  }
  if (photographs != 1) return;
  WriteCapture(InitOptionsOf(ReadDraft(capture), capture));
  fs::remove(capture / kDraftFile, error);
}

}  // namespace glint
