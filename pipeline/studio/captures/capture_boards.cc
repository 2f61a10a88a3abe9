#include "pipeline/studio/captures/capture_boards.h"

#include <optional>
#include <set>
#include <string>

#include "base/errors/errors.h"
#include "base/formats/capture.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// board.json tells the sheet as well; else capture.toml describes the board alone.
std::optional<BoardFile> BoardFileOf(const fs::path& folder) {
  try {
    std::error_code error;
    if (fs::is_regular_file(folder / "board.json", error)) {
      return ReadBoardFile(folder / "board.json");
    }
    const Capture capture = ReadCapture(folder, Photographs::kMayBeMissing);
    if (!capture.has_board || capture.fixed_camera()) return std::nullopt;
    return BoardFile{capture.board, std::nullopt};
  } catch (const Error&) {  // the capture's own page says what is wrong
    return std::nullopt;
  }
}

}  // namespace

std::vector<KeptBoard> BoardsOfCaptures(const std::vector<LibraryEntry>& captures,
                                        const std::vector<KeptBoard>& kept) {
  std::set<std::string> seen;
  for (const KeptBoard& board : kept) seen.insert(DescriptionOf(board.file.board));
  std::vector<KeptBoard> boards;
  for (const LibraryEntry& entry : captures) {
    const auto file = BoardFileOf(entry.folder);
    if (!file || !seen.insert(DescriptionOf(file->board)).second) continue;
    boards.push_back({IdOf("board of " + entry.id), entry.name, entry.folder, *file});
  }
  return boards;
}

}  // namespace glint
