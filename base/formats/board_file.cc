#include "base/formats/board_file.h"

#include <fmt/format.h>

#include "base/board/board_kind.h"
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
  Json json = {{"glint_board", kBoardFormat}, {"kind", KindOf(board.kind).name()}};
  KindOf(board.kind).Write(board, &json);
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
  const std::string remedy =
      fmt::format("use one of \"{}\"", fmt::join(BoardKindNames(), "\", \""));
  const std::optional<BoardKind> kind = BoardKindNamed(object.Text("kind", remedy));
  if (!kind) object.Reject("kind", remedy);
  BoardFile result;
  result.board = KindOf(*kind).Read(&object);
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
