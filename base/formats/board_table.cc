#include "base/formats/board_table.h"

#include "base/board/board_kind.h"
#include "base/board/dictionary.h"
#include "base/errors/errors.h"
#include "base/files/toml_file.h"
#include "base/files/toml_table.h"
#include "base/formats/board_file.h"
#include "base/formats/capture_files.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// file = "board.json", with the length of its ruler where somebody measured the print.
void TakeBoardFile(const fs::path& folder, const fs::path& file, TomlTable* table,
                   BoardTable* result) {
  const auto names = MatchFiles(folder, table->Text("file", ""), file, "board.file");
  if (names.size() != 1) {
    throw UserError(file, "board.file", std::to_string(names.size()) + " files that match",
                    "name one board.json");
  }
  result->file = names[0];
  const fs::path description = folder / names[0];
  result->board = ReadBoardFile(description).board;
  const double measured = table->Number("measured_ruler_mm", 0, 1, 1e5, " of millimetres");
  if (measured > 0) {
    ScaleBoard(RulerFactor(description, result->board, measured), &result->board);
  }
}

Board DescribedBoard(TomlTable* table) {
  Board board;
  const std::optional<BoardKind> known = BoardKindNamed(table->Text("kind", "charuco"));
  if (known && !KindOf(*known).fits_capture_toml()) {
    table->Reject(*table->Find("kind"), "kind",
                  "describe it in a board.json (docs/boards.md) and name that: file = "
                  "\"board.json\"");
  }
  const std::string kind = table->Text("kind", "charuco", BoardKindNames(true));
  board.kind = BoardKindNamed(kind).value();
  const auto squares =
      table->Integers("squares", 2, false, "give [columns, rows] of squares as whole numbers");
  const auto corners =
      table->Integers("inner_corners", 2, false, "give [columns, rows] of inner corners");
  if (squares.empty() == corners.empty()) {
    table->Missing("squares",
                   "give either squares = [columns, rows] or inner_corners = [columns, rows]");
  }
  board.squares_x = squares.empty() ? corners[0] + 1 : squares[0];
  board.squares_y = squares.empty() ? corners[1] + 1 : squares[1];
  board.square_mm = table->Number("square_mm", 0, 1e-3, 1e4, " of millimetres, greater than 0");
  board.marker_mm = table->Number("marker_mm", 0, 1e-3, 1e4, " of millimetres, greater than 0");
  board.dictionary = DictionaryFromAnyName(table->Text("dictionary", board.dictionary));
  board.legacy_layout = table->Flag("legacy_layout", false);
  const auto window = table->Integers("window", 4, false,
                                      "give [first column, first row, columns, rows] in squares");
  if (!window.empty()) board.window = BoardWindow{window[0], window[1], window[2], window[3]};
  if (table->Find("measured_ruler_mm") != nullptr) {
    table->Reject(*table->Find("measured_ruler_mm"), "measured_ruler_mm",
                  "it goes with file = \"board.json\"; without one, measure a square and give "
                  "square_mm");
  }
  return board;
}

void CheckDescribed(const fs::path& file, const TomlTable& table, const Board& board) {
  if (board.square_mm == 0) table.Missing("square_mm", "give the side of a square in millimetres");
  if (const std::string wrong = CheckBoard(board); !wrong.empty()) {
    throw UserError(file.string() + ": board: " + wrong);
  }
}

}  // namespace

std::optional<BoardTable> ReadBoardTable(const fs::path& folder, const fs::path& file,
                                         const toml::table& document) {
  TomlTable table(file, document, "board");
  if (!table.present()) return std::nullopt;
  BoardTable result;
  const bool from_file = table.Find("file") != nullptr;
  if (from_file) {
    TakeBoardFile(folder, file, &table, &result);
  } else {
    result.board = DescribedBoard(&table);
  }
  result.photos = ReadPhotos(folder, "photos", &table, file);
  table.RejectUnknown();
  if (!from_file) CheckDescribed(file, table, result.board);
  return result;
}

Board ReadDescribedBoard(const fs::path& file) {
  const auto document = ReadTomlFile(file);
  TomlTable table(file, *document, "board");
  if (!table.present()) {
    throw UserError(file, "board", "no such table", "give a file that describes a board");
  }
  if (const toml::node* name = table.Find("file")) {
    table.Reject(*name, "file", "give that file itself");
  }
  const Board board = DescribedBoard(&table);
  for (const char* other : {"photos", "video", "every"}) table.Find(other);
  table.RejectUnknown();
  CheckDescribed(file, table, board);
  return board;
}

}  // namespace glint
