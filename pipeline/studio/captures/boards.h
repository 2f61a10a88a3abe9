// Boards that were printed, kept beneath Studio's folder to be chosen again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/contract/board_file.h"
#include "pipeline/files/json.h"

namespace glint {

struct KeptBoard {
  std::string id, name;
  std::filesystem::path folder;  // with board.json and board.pdf
  BoardFile file;
};

class BoardShelf {
 public:
  explicit BoardShelf(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::vector<KeptBoard> List() const;  // by name; folders that hold no board are passed over
  std::optional<KeptBoard> Find(const std::string& id) const;
  // The id of the board whose description the capture has.
  std::optional<std::string> BoardOf(const std::filesystem::path& capture) const;
  // Runs `glint board`: `paper` is "A4", "Letter" …; `window_mm` what the window must hold, or
  // none. A board of the same making is not made twice. Throws HttpError with what the program
  // says.
  KeptBoard Print(const std::string& paper, const std::optional<std::array<double, 2>>& window_mm);
  // The printed ruler's length: `glint board --measured`.
  KeptBoard Measure(const std::string& id, double ruler_mm);

 private:
  std::filesystem::path folder_;
};

// {id, name, paper, squares, square_mm, window_mm, ruler_mm}
Json ToJson(const KeptBoard& board);

// Width and height of the window; none: a whole board.
std::optional<std::array<double, 2>> WindowOf(const Board& board);

}  // namespace glint
