// What there is to know of a kind of board: the fields of its description, what is printed where,
// and where its paper is white. To add one: its enumerator and its fields in board.h, a source like
// checkerboard.cc with its row in board_kinds.cc; what finds it, in calib/corners (a row of
// detector.cc), and what plans a sheet of it (a row of calib/printing/sheet_plan.cc).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/board/board.h"
#include "base/files/json.h"
#include "base/files/json_object.h"

namespace glint {

// What is printed of one board.
class BoardInk {
 public:
  virtual ~BoardInk() = default;
  // 0 ink, 1 paper; nullopt: there is no sheet. Without the sheet's outer border and patches.
  virtual std::optional<double> ReflectanceAt(const Eigen::Vector2d& in_sample_mm) const = 0;
};

// A black shape: polygons that do not overlap, in the sample frame, in millimetres.
using InkShape = std::vector<std::vector<Eigen::Vector2d>>;

// Boards that are given to these functions are of this kind; all but Check() want boards that it
// finds nothing wrong with.
class KindOfBoard {
 public:
  virtual ~KindOfBoard() = default;
  virtual const char* name() const = 0;     // in descriptions and options
  virtual const char* summary() const = 0;  // in --help: what it is for
  // Whether capture.toml can describe it without a board.json: by squares, marker_mm, dictionary,
  // legacy_layout and window.
  virtual bool fits_capture_toml() const = 0;

  // The fields of board.json that are its own. Throws UserError: file, field, found, remedy.
  virtual Board Read(JsonObject* object) const = 0;
  virtual void Write(const Board& board, Json* json) const = 0;
  virtual std::string Check(const Board& board) const = 0;  // as CheckBoard
  virtual std::string InWords(const Board& board) const = 0;
  // All that is not in board.json, as options in manifests have it.
  virtual std::string InOneLine(const Board& board) const = 0;

  virtual BoardRectangle Outline(const Board& board) const = 0;
  virtual std::optional<BoardRectangle> Opening(const Board& board) const = 0;
  virtual bool LooksTheSameUpsideDown(const Board& board) const = 0;
  virtual std::vector<BoardCorner> Corners(const Board& board) const = 0;
  virtual std::vector<BoardMarker> Markers(const Board& board) const = 0;
  virtual std::vector<PaperSpot> Paper(const Board& board) const = 0;
  virtual std::unique_ptr<const BoardInk> Ink(const Board& board) const = 0;
  // The same for printing.
  virtual std::vector<InkShape> Shapes(const Board& board) const = 0;
};

const KindOfBoard& KindOf(BoardKind kind);

// All of them, in the order in which messages name them.
const std::vector<BoardKind>& BoardKinds();

std::vector<std::string> BoardKindNames(bool in_capture_toml = false);
// none: no kind of that name
std::optional<BoardKind> BoardKindNamed(const std::string& name);

// Of single sources.
const KindOfBoard& CharucoKind();
const KindOfBoard& CheckerboardKind();
const KindOfBoard& MarkerFrameKind();

}  // namespace glint
