#include "pipeline/studio/captures/notes.h"

#include "base/errors/errors.h"
#include "pipeline/files/files.h"
#include "pipeline/files/json_file.h"
#include "pipeline/studio/captures/library.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

fs::path VerdictNote(const fs::path& capture) { return StudioFolderOf(capture) / "advice.json"; }
fs::path UndecidedNote(const fs::path& capture) {
  return StudioFolderOf(capture) / "undecided.json";
}

Json ReadNote(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return nullptr;
  try {
    return ReadJsonFile(file, "");
  } catch (const Error&) {
    return nullptr;
  }
}

void WriteNote(const fs::path& file, const Json& json) {
  if (ReadNote(file) == json) return;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  try {
    WriteFileAtomically(file, json.dump() + "\n");
  } catch (const Error&) {
  }
}

}  // namespace

std::string NotedVerdict(const fs::path& capture) {
  const Json note = ReadNote(VerdictNote(capture));
  return note.is_object() ? note.value("verdict", "none") : "none";
}

void NoteVerdict(const fs::path& capture, const std::string& verdict) {
  WriteNote(VerdictNote(capture), {{"verdict", verdict}});
}

std::set<std::string> UndecidedPhotos(const fs::path& capture) {
  const Json list = ReadNote(UndecidedNote(capture));
  std::set<std::string> places;
  for (const Json& one : list.is_array() ? list : Json::array()) {
    if (one.is_string()) places.insert(one.get<std::string>());
  }
  return places;
}

void NoteUndecided(const fs::path& capture, const std::set<std::string>& places) {
  WriteNote(UndecidedNote(capture), Json(places));
}

}  // namespace glint
