#include "pipeline/studio/captures/notes.h"

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/json_file.h"
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

std::string TextAt(const Json& json, const std::string& place) {
  const Json::json_pointer pointer(place);
  if (!json.is_object() || !json.contains(pointer) || !json[pointer].is_string()) return "";
  return json[pointer].get<std::string>();
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
  std::string verdict = TextAt(note, "/verdict");
  if (!verdict.empty() && verdict != "none") return verdict;
  const Json manifest = ReadNote(capture / "glint" / "calib" / "manifest.json");
  std::string word = TextAt(manifest, "/metrics/guidance/verdict");
  if (word == "good" || word == "usable") return word;
  return word.empty() ? "none" : "poor";  // "not enough"
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
