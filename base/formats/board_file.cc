#include "base/formats/board_file.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/board/dictionary.h"
#include "base/errors/errors.h"
#include "base/files/json_file.h"
#include "base/files/json_object.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxBytes = 4u << 20;
constexpr std::size_t kMostPatches = 1000;

Json ListOf(const Eigen::Vector2d& v) { return Json::array({v.x(), v.y()}); }

Json ListOf(const BoardRectangle& r) {
  return Json::array({r.left_mm, r.bottom_mm, r.right_mm, r.top_mm});
}

Eigen::Vector2d Point(const std::vector<double>& numbers) { return {numbers[0], numbers[1]}; }

BoardRectangle RectangleIn(JsonObject* object, const std::string& key) {
  const std::string remedy = "give [left, bottom, right, top] in millimetres";
  const auto n = object->Numbers(key, 4, remedy);
  if (!(n[0] < n[2]) || !(n[1] < n[3])) object->Reject(key, remedy);
  return {n[0], n[1], n[2], n[3]};
}

// Either four corners, or the centre and side of an upright or turned square.
ListedMarker MarkerIn(JsonObject object) {
  ListedMarker marker;
  marker.id = object.Integer("id", "give the marker's number in the dictionary");
  if (object.Has("corners_mm")) {
    const Json& list = object.Array("corners_mm", 4, "give four [x, y] in millimetres");
    for (int k = 0; k < 4; ++k) {
      const Json& corner = list[static_cast<std::size_t>(k)];
      if (!corner.is_array() || corner.size() != 2 || !corner[0].is_number() ||
          !corner[1].is_number()) {
        object.Reject("corners_mm", "give four [x, y] in millimetres");
      }
      marker.corners_in_board_mm[k] = {corner[0].get<double>(), corner[1].get<double>()};
    }
  } else {
    const auto centre =
        Point(object.Numbers("centre_mm", 2, "give [x, y] in millimetres, or corners_mm"));
    const double half = 0.5 * object.Number("side_mm", 1e-3, 1e4, "give the printed side");
    const double turn =
        object.Has("turn_deg") ? object.Number("turn_deg", -360, 360, "in degrees") : 0;
    const double c = std::cos(turn * std::numbers::pi / 180);
    const double s = std::sin(turn * std::numbers::pi / 180);
    const Eigen::Vector2d right(half * c, half * s), up(-half * s, half * c);
    marker.corners_in_board_mm[0] = centre - right + up;
    marker.corners_in_board_mm[1] = centre + right + up;
    marker.corners_in_board_mm[2] = centre + right - up;
    marker.corners_in_board_mm[3] = centre - right - up;
  }
  object.RejectUnknown();
  return marker;
}

Board MarkerBoardIn(JsonObject* object) {
  const std::string dictionary =
      DictionaryFromAnyName(object->Text("dictionary", "name it, for example \"tag36h11\""));
  const Json& list = object->Array("markers", 0, "list the markers");
  std::vector<ListedMarker> markers;
  for (std::size_t i = 0; i < list.size(); ++i) {
    markers.push_back(MarkerIn(object->Element("markers", i)));
  }
  Board board = MakeMarkerBoard(dictionary, std::move(markers));
  if (object->Has("opening_mm")) board.opening_in_board = RectangleIn(object, "opening_mm");
  return board;
}

Board SquaresIn(JsonObject* object, BoardKind kind) {
  Board board;
  board.kind = kind;
  const std::string remedy = "give [columns, rows] of squares";
  const auto squares = object->Integers("squares", 2, remedy);
  board.squares_x = squares[0];
  board.squares_y = squares[1];
  board.square_mm = object->Number("square_mm", 1e-3, 1e4, "give the side of a square");
  if (kind == BoardKind::kCheckerboard) return board;
  board.marker_mm = object->Number("marker_mm", 1e-3, 1e4, "give the side of a marker");
  board.dictionary =
      DictionaryFromAnyName(object->Text("dictionary", "name it, for example \"DICT_5X5_1000\""));
  if (object->Has("legacy_layout")) board.legacy_layout = object->Flag("legacy_layout");
  if (object->Has("window")) {
    const auto w = object->Integers("window", 4, "give [first column, first row, columns, rows]");
    board.window = BoardWindow{w[0], w[1], w[2], w[3]};
  }
  return board;
}

void ReadExtras(JsonObject* object, Board* board) {
  if (object->Has("ruler")) {
    JsonObject ruler = object->Member("ruler");
    BoardRuler marks;
    marks.from_in_board_mm = Point(ruler.Numbers("from_mm", 2, "give [x, y] in millimetres"));
    marks.to_in_board_mm = Point(ruler.Numbers("to_mm", 2, "give [x, y] in millimetres"));
    ruler.RejectUnknown();
    if (!(marks.length_mm() >= 1)) object->Reject("ruler", "give two different points");
    board->ruler = marks;
  }
  if (object->Has("patches")) {
    const Json& list = object->Array("patches", 0, "list the patches");
    if (list.size() > kMostPatches) object->Reject("patches", "list at most 1000");
    for (std::size_t i = 0; i < list.size(); ++i) {
      JsonObject patch = object->Element("patches", i);
      board->patches.push_back({RectangleIn(&patch, "rectangle_mm"),
                                patch.Number("reflectance", 0, 1.2, "give it as a share of 1")});
      patch.RejectUnknown();
    }
  }
  if (object->Has("print_scale")) {
    board->print_scale = object->Number("print_scale", 0.01, 100, "printed over designed size");
  }
}

BoardSheet SheetIn(JsonObject sheet) {
  const auto size = sheet.Numbers("size_mm", 2, "give [width, height] in millimetres");
  const auto centre = sheet.Numbers("board_centre_mm", 2, "give [x, y] in millimetres");
  if (!(size[0] > 0 && size[1] > 0 && size[0] < 1e5 && size[1] < 1e5)) {
    sheet.Reject("size_mm", "give [width, height] in millimetres");
  }
  sheet.RejectUnknown();
  return {size[0], size[1], Point(centre)};
}

}  // namespace

Json ToJson(const BoardFile& file) {
  const Board& board = file.board;
  Json json = {{"glint_board", kBoardFormat}, {"kind", BoardKindName(board.kind)}};
  if (board.kind == BoardKind::kMarkers) {
    json["dictionary"] = board.dictionary;
    json["markers"] = Json::array();
    for (const ListedMarker& marker : board.markers) {
      Json corners = Json::array();
      for (const Eigen::Vector2d& corner : marker.corners_in_board_mm) {
        corners.push_back(ListOf(corner));
      }
      json["markers"].push_back({{"id", marker.id}, {"corners_mm", corners}});
    }
    if (board.opening_in_board) json["opening_mm"] = ListOf(*board.opening_in_board);
  } else {
    json["squares"] = {board.squares_x, board.squares_y};
    json["square_mm"] = board.square_mm;
  }
  if (board.kind == BoardKind::kCharuco) {
    json["marker_mm"] = board.marker_mm;
    json["dictionary"] = board.dictionary;
    json["legacy_layout"] = board.legacy_layout;
    if (board.window) {
      json["window"] = {board.window->first_column, board.window->first_row, board.window->columns,
                        board.window->rows};
    }
  }
  if (board.ruler) {
    json["ruler"] = {{"from_mm", ListOf(board.ruler->from_in_board_mm)},
                     {"to_mm", ListOf(board.ruler->to_in_board_mm)}};
  }
  for (const BoardPatch& patch : board.patches) {
    json["patches"].push_back(
        {{"rectangle_mm", ListOf(patch.in_board)}, {"reflectance", patch.reflectance}});
  }
  if (board.print_scale != 1) json["print_scale"] = board.print_scale;
  if (file.sheet) {
    json["sheet"] = {{"size_mm", {file.sheet->width_mm, file.sheet->height_mm}},
                     {"board_centre_mm", ListOf(file.sheet->board_centre_mm)}};
  }
  return json;
}

BoardFile ReadBoardFile(const fs::path& file) {
  const Json json =
      ReadJsonFile(file, "write it with glint board, or as docs/boards.md says", kMaxBytes);
  JsonObject object(file, "", json);
  if (object.Integer("glint_board", "give the format's version, 1") != kBoardFormat) {
    object.Reject("glint_board",
                  "this program reads version " + std::to_string(kBoardFormat) + " of the format");
  }
  const std::string remedy = "use \"charuco\", \"checkerboard\" or \"markers\"";
  const std::string kind = object.Text("kind", remedy);
  const std::optional<BoardKind> known = BoardKindNamed(kind);
  if (!known) object.Reject("kind", remedy);
  BoardFile result;
  result.board =
      *known == BoardKind::kMarkers ? MarkerBoardIn(&object) : SquaresIn(&object, *known);
  ReadExtras(&object, &result.board);
  if (object.Has("sheet")) result.sheet = SheetIn(object.Member("sheet"));
  if (object.Has("about")) object.Text("about", "give a text");
  object.RejectUnknown();
  if (const std::string wrong = CheckBoard(result.board); !wrong.empty()) {
    throw UserError(file.string() + ": " + wrong);
  }
  return result;
}

double RulerFactor(const fs::path& file, const Board& board, double measured_mm) {
  if (!board.ruler) {
    throw UserError(file, "ruler", "no such field, but a measured ruler",
                    "give the points between which it was measured, as docs/boards.md says");
  }
  const double factor = measured_mm / board.ruler->length_mm();
  // A3 on A5 is 0.5. Centimetres or inches taken for millimetres are farther off.
  if (factor > 0.4 && factor < 2.5) return factor;
  throw UserError(
      file, "ruler",
      fmt::format("{} mm measured on a ruler of {:.6g} mm", measured_mm, board.ruler->length_mm()),
      "measure the whole ruler, in millimetres");
}

std::string PrintScaleInWords(const Board& board) {
  std::string text = fmt::format("{:.2f} % of its size", 100 * board.print_scale);
  if (!board.ruler) return text;
  const double length_mm = board.ruler->length_mm();
  return text + fmt::format(": its ruler of {:.6g} mm is {:.2f} mm long",
                            length_mm / board.print_scale, length_mm);
}

}  // namespace glint
