// Boards to choose from: those that were printed and are kept beneath Studio's folder, and those of
// captures that are there.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/formats/board_file.h"
#include "pipeline/studio/captures/library.h"

namespace glint {

struct KeptBoard {
  std::string id, name;
  std::filesystem::path folder;  // with board.json and board.pdf; a capture's may lack both
  BoardFile file;
};

class BoardShelf {
 public:
  // `captures` lists those whose boards may be chosen as well.
  BoardShelf(std::filesystem::path folder, std::function<std::vector<LibraryEntry>()> captures)
      : folder_(std::move(folder)), captures_(std::move(captures)) {}

  std::vector<KeptBoard> List() const;  // printed ones first
  std::optional<KeptBoard> Find(const std::string& id) const;
  // The same, to be used by one more capture: another capture's board is copied to the printed
  // ones, so that it keeps its name and place whatever becomes of that capture.
  std::optional<KeptBoard> Take(const std::string& id) const;
  // The id of the printed board with a PDF whose description the capture has.
  std::optional<std::string> BoardOf(const std::filesystem::path& capture) const;
  // Runs `glint board`: `paper` is "A4", "Letter" …; `window_mm` what the window must hold, or
  // none. A board of the same making is not made twice. Throws HttpError with what the program
  // says.
  KeptBoard Print(const std::string& paper, const std::optional<std::array<double, 2>>& window_mm);
  // The printed ruler's length: `glint board --measured`. A capture stays as it is: see Take.
  KeptBoard Measure(const std::string& id, double ruler_mm);

 private:
  std::vector<KeptBoard> Printed() const;  // by name; folders that hold no board are passed over
  KeptBoard Adopt(const KeptBoard& board) const;

  std::filesystem::path folder_;
  std::function<std::vector<LibraryEntry>()> captures_;
};

// board.json of the board.
std::string BoardText(const KeptBoard& board);

// {id, name, paper, squares, square_mm, window_mm, ruler_mm, print_scale, pdf}
Json ToJson(const KeptBoard& board);

// Width and height of the window; none: a whole board.
std::optional<std::array<double, 2>> WindowOf(const Board& board);

}  // namespace glint
