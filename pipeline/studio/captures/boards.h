// Boards to choose from: those that were printed or described and are kept beneath Studio's folder,
// those of captures that are there, and those that Studio knows.
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
  // With board.json and board.pdf; a capture's may lack both. Empty: a board that Studio knows.
  std::filesystem::path folder;
  BoardFile file;
};

class BoardShelf {
 public:
  // `captures` lists those whose boards may be chosen as well.
  BoardShelf(std::filesystem::path folder, std::function<std::vector<LibraryEntry>()> captures)
      : folder_(std::move(folder)), captures_(std::move(captures)) {}

  std::vector<KeptBoard> List() const;  // kept ones first, those that Studio knows last
  std::optional<KeptBoard> Find(const std::string& id) const;
  // The kept copy of a board that a capture uses: another capture's is copied, so that it keeps its
  // name and place whatever becomes of that capture.
  KeptBoard Adopt(const KeptBoard& board) const;
  // The kept board of the same description, on whatever sheet.
  std::optional<KeptBoard> Same(const Board& board) const;
  // Runs `glint board`: `paper` is "A4", "Letter" …; `window_mm` what the window must hold, or
  // none. A board of the same making is not made twice. Throws HttpError with what the program
  // says.
  KeptBoard Print(const std::string& paper, const std::optional<std::array<double, 2>>& window_mm);
  // Keeps a board that a person describes: see given_board.h. One of the same description is not
  // kept twice. Throws UserError for what describes no board.
  KeptBoard Describe(const std::string& file_name, const std::string& text) const;
  // The printed ruler's length: `glint board --measured`. A capture stays as it is: see Adopt.
  KeptBoard Measure(const std::string& id, double ruler_mm);

 private:
  std::vector<KeptBoard> Kept() const;  // by name; folders that hold no board are passed over
  KeptBoard Keep(const std::string& name, const std::string& text) const;

  std::filesystem::path folder_;
  std::function<std::vector<LibraryEntry>()> captures_;
};

// board.json of the board.
std::string BoardText(const KeptBoard& board);

// The same text for boards of the same description, on whatever sheet.
std::string DescriptionOf(const Board& board);

// {id, name, words, paper, squares, square_mm, window_mm, ruler_mm, print_scale, pdf, known}
Json ToJson(const KeptBoard& board);

// Width and height of the window; none: a whole board.
std::optional<std::array<double, 2>> WindowOf(const Board& board);

// Throw HttpError 422 for what is no size, and where the window is smaller than the sample.
void RequireSampleSize(const std::array<double, 2>& sample_mm);
void RequireRoomFor(const std::array<double, 2>& sample_mm, const Board& board);

}  // namespace glint
