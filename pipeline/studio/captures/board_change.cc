#include "pipeline/studio/captures/board_change.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>

#include <string>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/board_table.h"
#include "base/formats/capture.h"
#include "pipeline/studio/captures/capture_edit.h"
#include "pipeline/studio/captures/toml_edit.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr char kBoardFile[] = "board.json";

std::string WithBoardFile(const fs::path& file, const std::string& text, const std::string& name) {
  return WithTomlValue(file, text, "board", "file", Json(name));
}

// capture.toml with the size and, of another board, its file in place of the old one's figures.
std::string Changed(const fs::path& file, std::string text, const BoardChange& change,
                    bool is_another) {
  if (change.size_mm) {
    text = WithTomlValue(file, text, "sample", "size_mm", Json(*change.size_mm));
  }
  if (!is_another) return text;
  text = WithBoardFile(file, text, kBoardFile);
  for (const char* key : kBoardDescriptionKeys) {
    text = WithTomlValue(file, text, "board", key, std::nullopt);
  }
  return WithTomlValue(file, text, "board", "measured_ruler_mm", std::nullopt);  // of the old print
}

// Under the first free name; returns it. Text that is kept already is not kept twice.
std::string KeepText(const fs::path& folder, const std::string& text) {
  std::error_code error;
  for (int n = 1;; ++n) {
    std::string name = fmt::format("board-{}.json", n);
    if (!fs::exists(folder / name, error)) {
      WriteFileAtomically(folder / name, text);
      return name;
    }
    if (fs::is_regular_file(folder / name, error) && ReadTextFile(folder / name) == text) {
      return name;
    }
  }
}

// Its board.json, which returns under which name; empty: there was none.
std::string KeepOldBoard(const Capture& capture) {
  if (capture.board_file.empty()) {
    KeepText(capture.folder, ToJson(BoardFile{capture.board, std::nullopt}).dump(2) + "\n");
  }
  std::error_code error;
  const fs::path file = capture.folder / kBoardFile;
  return fs::exists(file, error) ? KeepText(capture.folder, ReadTextFile(file)) : "";
}

void KeepSheets(const fs::path& folder, const std::string& kept) {
  for (const char* ending : {".pdf", ".svg"}) {
    const fs::path from = (folder / kBoardFile).replace_extension(ending);
    const fs::path to = (folder / kept).replace_extension(ending);
    (void)::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE);
  }
}

// Nothing of the new board is in force until capture.toml names it. `kept`: under which name the
// old board.json is kept.
void PutBoard(const Capture& capture, const BoardChange& change, const std::string& kept) {
  if (capture.board_file == kBoardFile) {
    EditCapture(capture.folder, [&](const Capture& now, const std::string& text) {
      return WithBoardFile(now.file, text, kept);
    });
  }
  WriteFileAtomically(capture.folder / kBoardFile, BoardText(change.board));
  EditCapture(capture.folder, [&](const Capture& now, const std::string& text) {
    return Changed(now.file, text, change, true);
  });
}

void PutBack(const Capture& capture, const std::string& toml, const std::string& kept) {
  const fs::path file = capture.folder / kBoardFile;
  if (!kept.empty()) WriteFileAtomically(file, ReadTextFile(capture.folder / kept));
  WriteFileAtomically(capture.file, toml);
  std::error_code error;
  if (kept.empty()) fs::remove(file, error);
}

}  // namespace

void ChangeBoard(const fs::path& folder, const BoardChange& change) {
  const Capture capture = ReadCapture(folder, Photographs::kMayBeMissing);
  const auto size_mm = change.size_mm.value_or(capture.sample_size_mm);
  RequireSampleSize(size_mm);
  RequireRoomFor(size_mm, change.board.file.board);
  const std::string text = ReadTextFile(capture.file);
  const bool is_another = DescriptionOf(capture.board) != DescriptionOf(change.board.file.board);
  // Throws before anything is written, where it cannot be.
  (void)Changed(capture.file, text, change, is_another);
  if (!is_another) {
    return EditCapture(folder, [&](const Capture& now, const std::string& before) {
      return Changed(now.file, before, change, false);
    });
  }
  const std::string kept = KeepOldBoard(capture);
  PutBoard(capture, change, kept);
  try {
    (void)ReadCapture(folder, Photographs::kMayBeMissing);
  } catch (const UserError&) {  // a sample out of all proportion to the board
    PutBack(capture, text, kept);
    throw;
  }
  if (!kept.empty()) KeepSheets(folder, kept);
}

}  // namespace glint
