#include "pipeline/studio/captures/given_board.h"

#include <fmt/format.h>

#include "base/board/board_kind.h"
#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/board_table.h"
#include "pipeline/studio/access/token.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// A folder that is gone with this; what a killed Studio leaves of it goes at the next start.
class ScratchFolder {
 public:
  explicit ScratchFolder(const fs::path& within) : path_(within / ("new-" + RandomToken())) {
    std::error_code error;  // which whoever writes into it meets
    fs::create_directories(path_, error);
  }
  ~ScratchFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

bool IsJson(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return first != std::string::npos && text[first] == '{';
}

std::string Replaced(std::string text, const std::string& what, const std::string& with) {
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
    text.replace(at, what.size(), with);
    at += with.size();
  }
  return text;
}

// "charuco-18x14-13mm"; a marker frame's millimetres are its markers' sides.
std::string NameFor(const Board& board) {
  const std::string squares =
      board.squares_x > 0 ? fmt::format("-{}x{}", board.squares_x, board.squares_y) : "";
  return fmt::format("{}{}-{:.4g}mm", KindOf(board.kind).name(), squares, board.square_mm);
}

// What programs call such files tells nothing.
std::string NameOf(const std::string& file_name, const Board& board) {
  const std::string stem = fs::path(file_name).stem();
  return stem.empty() || stem == "board" || stem == "capture" ? NameFor(board) : stem;
}

}  // namespace

GivenBoard ReadGivenBoard(const std::string& file_name, const std::string& text,
                          const fs::path& scratch) {
  const bool json = IsJson(text);
  const ScratchFolder folder(scratch);
  const fs::path file = folder.path() / (json ? "board.json" : "capture.toml");
  WriteFileAtomically(file, text);
  try {
    GivenBoard given;
    given.file = json ? ReadBoardFile(file) : BoardFile{ReadDescribedBoard(file), std::nullopt};
    given.text = json ? text : ToJson(given.file).dump(2) + "\n";
    given.name = NameOf(file_name, given.file.board);
    return given;
  } catch (const UserError& error) {
    const std::string called = file_name.empty() ? "the board" : file_name;
    throw UserError(Replaced(error.what(), file.string(), called));
  }
}

}  // namespace glint
