// A capture begun in Studio: what `glint init` would write, before there are photographs.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "base/files/json.h"
#include "pipeline/studio/captures/boards.h"

namespace glint {

struct NewCapture {
  std::string name;
  std::string kind = "board";  // "board" or "single"
  std::optional<std::array<double, 2>> size_mm;
  std::optional<double> height_mm;               // of the sample above the board; none: "auto"
  std::optional<KeptBoard> board;                // "board"
  double picture_width_mm = 0, distance_mm = 0;  // "single": one of them
};

// Makes `root`/NAME with photos/ and, for a board, board.json and capture.toml; for one photograph
// a draft, since `glint init --single` reads the photograph. Whole or not at all. Returns the
// folder. Throws HttpError: no name, a folder that is there, a sample that the window does not
// hold.
std::filesystem::path MakeCapture(const std::filesystem::path& root, const NewCapture& wanted);

// Of a capture without capture.toml.
bool IsDraft(const std::filesystem::path& capture);
// Throws UserError for a file that is no draft.
NewCapture ReadDraft(const std::filesystem::path& capture);
// Writes capture.toml as `glint init` does where the one photograph is there; else does nothing.
void FinishDraft(const std::filesystem::path& capture);

}  // namespace glint
