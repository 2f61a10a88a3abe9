#include "calib/printing/sheet_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

#include "base/board/board_kind.h"
#include "base/board/dictionary.h"
#include "base/colour/srgb.h"
#include "base/errors/errors.h"

namespace glint {
namespace {

constexpr double kRulerStrip_mm = 16;  // ruler and two lines of text, below the board
constexpr double kPatchStrip_mm = 16;  // above it
constexpr double kPatchPitch_mm = 12, kPatch_mm = 10;
constexpr int kFrameSquares = 3;      // squares left standing on each side of a window of our own
constexpr double kSampleFree_mm = 1;  // between the sample and the window's edge
constexpr int kSquaresAcross = 13;    // of the sheet's shorter side

// The part of the sheet that the board may take.
struct Space {
  double width_mm = 0, height_mm = 0, left_mm = 0, bottom_mm = 0;
};

Space SpaceOn(const SheetOptions& options, const Eigen::Vector2d& paper_mm) {
  const double patches_mm = options.patches.empty() ? 0 : kPatchStrip_mm;
  const double m = options.margin_mm;
  const Space space{paper_mm.x() - 2 * m, paper_mm.y() - 2 * m - kRulerStrip_mm - patches_mm, m,
                    m + kRulerStrip_mm};
  if (space.width_mm < 20 || space.height_mm < 20) {
    throw UserError(fmt::format("--paper: found {} x {} mm with margins of {} mm; use a larger one",
                                paper_mm.x(), paper_mm.y(), m));
  }
  return space;
}

std::vector<int> Whole(const std::vector<double>& numbers, size_t count, const std::string& option,
                       const std::string& what) {
  if (numbers.size() != count) {
    throw UserError(fmt::format("--{}: found {} numbers; give {}", option, numbers.size(), what));
  }
  std::vector<int> whole;
  for (const double number : numbers) {
    if (!(number >= 0 && number <= 1000) || number != std::floor(number)) {
      throw UserError(fmt::format("--{}: found {}; give whole numbers", option, number));
    }
    whole.push_back(static_cast<int>(number));
  }
  return whole;
}

double HalfMillimetres(double length_mm) { return std::floor(2 * length_mm + 1e-9) / 2; }

// A window in the middle that takes `needed` of `all` squares, and one more where only so it lies
// in the middle and a frame remains.
int WindowSquares(int needed, int all) {
  return (all - needed) % 2 != 0 && needed + 1 <= all - 2 ? needed + 1 : needed;
}

BoardWindow PlanWindow(const SheetOptions& options, const Board& board) {
  if (!options.window.empty()) {
    const auto w = Whole(options.window, 4, "window", "FIRST_COLUMN,FIRST_ROW,COLUMNS,ROWS");
    return {w[0], w[1], w[2], w[3]};
  }
  int columns = board.squares_x - 2 * kFrameSquares;
  int rows = std::min(columns, board.squares_y - 2 * kFrameSquares);
  if (!options.sample_mm.empty()) {
    if (options.sample_mm.size() != 2 || !(options.sample_mm[0] > 0 && options.sample_mm[1] > 0)) {
      throw UserError(
          "--sample-mm: found something other than two sizes greater than 0; give WIDTH,HEIGHT");
    }
    const auto needed = [&](double size_mm) {
      return static_cast<int>(
          std::ceil(std::min(1e6, (size_mm + 2 * kSampleFree_mm) / board.square_mm - 1e-9)));
    };
    columns = WindowSquares(needed(options.sample_mm[0]), board.squares_x);
    rows = WindowSquares(needed(options.sample_mm[1]), board.squares_y);
  }
  if (columns < 1 || rows < 1 || columns > board.squares_x - 2 || rows > board.squares_y - 2) {
    throw UserError(fmt::format(
        "--sample-mm: found a window of {} x {} squares of {} mm on a board of {} x {}; use a "
        "larger --paper, a smaller --square-mm or sample, or --full-board",
        columns, rows, board.square_mm, board.squares_x, board.squares_y));
  }
  return {(board.squares_x - columns) / 2, (board.squares_y - rows) / 2, columns, rows};
}

// Of an odd by an even number of squares a checkerboard looks different upside down. `free`: the
// number may be changed.
void GiveOneWayUp(bool free, Board* board) {
  if (!LooksTheSameUpsideDown(*board)) return;
  if (!free) {
    throw UserError(
        fmt::format("--squares: found {},{}, a checkerboard that looks the same upside down, so "
                    "that photographs "
                    "from the other side cannot be told; use {},{}, or --kind charuco",
                    board->squares_x, board->squares_y, board->squares_x, board->squares_y - 1));
  }
  --(board->squares_x > board->squares_y ? board->squares_x : board->squares_y);
}

Board PlanSquares(BoardKind kind, const SheetOptions& options, const Space& space) {
  Board board;
  board.kind = kind;
  std::vector<int> squares;
  if (!options.squares.empty()) squares = Whole(options.squares, 2, "squares", "COLUMNS,ROWS");
  board.square_mm = options.square_mm;
  if (board.square_mm == 0) {
    const double shorter = std::min(space.width_mm, space.height_mm);
    board.square_mm = squares.empty()
                          ? shorter / kSquaresAcross
                          : std::min(space.width_mm / squares[0], space.height_mm / squares[1]);
    // Sizes a person can read off a ruler; tiny boards as they come.
    if (board.square_mm >= 1) board.square_mm = HalfMillimetres(board.square_mm);
  }
  const auto fit = [&](double length_mm) {
    return static_cast<int>(std::min(200.0, std::floor(length_mm / board.square_mm + 1e-9)));
  };
  board.squares_x = squares.empty() ? fit(space.width_mm) : squares[0];
  board.squares_y = squares.empty() ? fit(space.height_mm) : squares[1];
  return board;
}

Board PlanCheckerboard(const SheetOptions& options, const Space& space) {
  Board board = PlanSquares(BoardKind::kCheckerboard, options, space);
  GiveOneWayUp(options.squares.empty(), &board);
  return board;
}

Board PlanCharuco(const SheetOptions& options, const Space& space) {
  Board board = PlanSquares(BoardKind::kCharuco, options, space);
  board.dictionary = DictionaryFromAnyName(options.dictionary);
  board.legacy_layout = options.legacy_layout;
  const double wanted = 0.74 * board.square_mm;
  board.marker_mm = options.marker_mm;
  if (board.marker_mm == 0) board.marker_mm = wanted >= 2 ? HalfMillimetres(wanted) : wanted;
  if (!options.full_board) board.window = PlanWindow(options, board);
  return board;
}

// Markers two sides apart round the sheet's middle, ids clockwise from the top left.
Board PlanMarkers(const SheetOptions& options, const Space& space) {
  std::vector<int> count = {5, 5};
  if (!options.squares.empty()) count = Whole(options.squares, 2, "squares", "ACROSS,DOWN");
  if (count[0] < 2 || count[1] < 2)
    throw UserError("--squares: found a side without markers; give ACROSS,DOWN, each at least 2");
  const double side = options.square_mm > 0
                          ? options.square_mm
                          : HalfMillimetres(std::min(space.width_mm / (2 * count[0] - 1),
                                                     space.height_mm / (2 * count[1] - 1)));
  std::vector<std::pair<int, int>> places;
  places.reserve(2 * static_cast<size_t>(count[0] + count[1]));
  for (int i = 0; i < count[0]; ++i) places.push_back({i, 0});
  for (int j = 1; j < count[1]; ++j) places.push_back({count[0] - 1, j});
  for (int i = count[0] - 2; i >= 0; --i) places.push_back({i, count[1] - 1});
  for (int j = count[1] - 2; j >= 1; --j) places.push_back({0, j});
  std::vector<ListedMarker> markers;
  for (const auto& [column, row] : places) {
    ListedMarker marker;
    marker.id = static_cast<int>(markers.size());
    const double x = (2 * column - (count[0] - 1)) * side, y = (count[1] - 1 - 2 * row) * side;
    const double h = 0.5 * side;
    marker.corners_in_board_mm[0] = {x - h, y + h};
    marker.corners_in_board_mm[1] = {x + h, y + h};
    marker.corners_in_board_mm[2] = {x + h, y - h};
    marker.corners_in_board_mm[3] = {x - h, y - h};
    markers.push_back(marker);
  }
  const bool squares_dictionary = options.dictionary == SheetOptions().dictionary;
  Board board = MakeMarkerBoard(
      DictionaryFromAnyName(squares_dictionary ? "tag36h11" : options.dictionary), markers);
  // Half a side of white inside the frame.
  const double x = (count[0] - 1) * side - side, y = (count[1] - 1) * side - side;
  if (x > 1 && y > 1 && !options.full_board) board.opening_in_board = BoardRectangle{-x, -y, x, y};
  return board;
}

struct Planner {
  BoardKind kind;
  Board (*plan)(const SheetOptions& options, const Space& space);
};

// One for each of BoardKinds().
constexpr Planner kPlanners[] = {
    {BoardKind::kCharuco, PlanCharuco},
    {BoardKind::kCheckerboard, PlanCheckerboard},
    {BoardKind::kMarkers, PlanMarkers},
};

void AddRuler(const BoardSheet& sheet, const Space& space, Board* board) {
  const double step = space.width_mm >= 50 ? 50 : 10;
  const double length = std::min(250.0, step * std::floor((space.width_mm - 8) / step));
  if (length < 10) return;
  const Eigen::Vector2d from =
      Eigen::Vector2d(space.left_mm, space.bottom_mm - kRulerStrip_mm + 8) - sheet.board_centre_mm;
  board->ruler = BoardRuler{from, from + Eigen::Vector2d(length, 0)};
}

void AddPatches(const SheetOptions& options, const BoardSheet& sheet, const Space& space,
                Board* board) {
  const double row_mm = kPatchPitch_mm * static_cast<double>(options.patches.size());
  if (row_mm > space.width_mm) {
    throw UserError(fmt::format("--patches: found {}; {} fit on this sheet", options.patches.size(),
                                static_cast<int>(space.width_mm / kPatchPitch_mm)));
  }
  Eigen::Vector2d at = Eigen::Vector2d(space.left_mm + 0.5 * (space.width_mm - row_mm),
                                       space.bottom_mm + space.height_mm + 4) -
                       sheet.board_centre_mm;
  for (const double wanted : options.patches) {
    if (!(wanted >= 0 && wanted <= options.paper_reflectance)) {
      throw UserError(
          fmt::format("--patches: found {}; give reflectances from 0 to that of the "
                      "paper, {}",
                      wanted, options.paper_reflectance));
    }
    const int level = LevelOfReflectance(wanted, options.paper_reflectance);
    board->patches.push_back({{at.x() + 1, at.y(), at.x() + 1 + kPatch_mm, at.y() + kPatch_mm},
                              ReflectanceOfLevel(level, options.paper_reflectance)});
    at.x() += kPatchPitch_mm;
  }
}

}  // namespace

Eigen::Vector2d PaperSize_mm(const std::string& paper, bool landscape) {
  static const std::map<std::string, Eigen::Vector2d> known = {
      {"a0", {841, 1189}},        {"a1", {594, 841}},         {"a2", {420, 594}},
      {"a3", {297, 420}},         {"a4", {210, 297}},         {"a5", {148, 210}},
      {"a6", {105, 148}},         {"letter", {215.9, 279.4}}, {"legal", {215.9, 355.6}},
      {"tabloid", {279.4, 431.8}}};
  std::string name = paper;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  Eigen::Vector2d size(0, 0);
  if (const auto found = known.find(name); found != known.end()) {
    size = found->second;
  } else {
    const size_t x = name.find('x');
    const char* end = name.data() + name.size();
    const auto number = [](const char* from, const char* to, double* value) {
      const auto [rest, error] = std::from_chars(from, to, *value);
      return error == std::errc() && rest == to;
    };
    const bool read = x != std::string::npos && number(name.data(), name.data() + x, &size.x()) &&
                      number(name.data() + x + 1, end, &size.y());
    if (!read || !(size.minCoeff() >= 20 && size.maxCoeff() <= 3000)) {
      throw UserError("--paper: found '" + paper +
                      "'; use A0 to A6, Letter, Legal, Tabloid or WIDTHxHEIGHT in millimetres "
                      "(20 to 3000)");
    }
  }
  if (landscape && size.x() < size.y()) std::swap(size.x(), size.y());
  return size;
}

int LevelOfReflectance(double reflectance, double paper_reflectance) {
  const double share = std::clamp(reflectance / paper_reflectance, 0.0, 1.0);
  return static_cast<int>(std::lround(255 * SrgbFromLinear(share)));
}

double ReflectanceOfLevel(int level, double paper_reflectance) {
  return std::round(1e4 * paper_reflectance * LinearFromSrgb(level / 255.0)) / 1e4;
}

void PlaceOnSheet(const SheetOptions& options, BoardFile* file) {
  Board& board = file->board;
  if (board.print_scale != 1) ScaleBoard(1 / board.print_scale, &board);
  const Eigen::Vector2d paper_mm = PaperSize_mm(options.paper, options.landscape);
  const Space space = SpaceOn(options, paper_mm);
  const BoardRectangle outline = OutlineInSample(board);
  const double width = outline.right_mm - outline.left_mm;
  const double height = outline.top_mm - outline.bottom_mm;
  if (width > space.width_mm + 1e-6 || height > space.height_mm + 1e-6) {
    throw UserError(
        fmt::format("--paper: found {} with room for {:.1f} x {:.1f} mm, while the board measures "
                    "{:.1f} x {:.1f} "
                    "mm; use larger paper, --landscape, or fewer or smaller squares",
                    options.paper, space.width_mm, space.height_mm, width, height));
  }
  const Eigen::Vector2d middle(0.5 * (outline.left_mm + outline.right_mm),
                               0.5 * (outline.bottom_mm + outline.top_mm));
  BoardSheet sheet{paper_mm.x(), paper_mm.y(),
                   Eigen::Vector2d(space.left_mm + 0.5 * space.width_mm,
                                   space.bottom_mm + 0.5 * space.height_mm) -
                       middle};
  AddRuler(sheet, space, &board);
  board.patches.clear();
  AddPatches(options, sheet, space, &board);
  file->sheet = sheet;
}

BoardFile PlanSheet(const SheetOptions& options) {
  const std::optional<BoardKind> kind = BoardKindNamed(options.kind);
  if (!kind) {
    throw UserError(fmt::format("--kind: found '{}'; use one of: {}", options.kind,
                                fmt::join(BoardKindNames(), ", ")));
  }
  const Space space = SpaceOn(options, PaperSize_mm(options.paper, options.landscape));
  BoardFile file;
  file.board =
      std::find_if(std::begin(kPlanners), std::end(kPlanners), [&](const Planner& planner) {
        return planner.kind == *kind;
      })->plan(options, space);
  if (const std::string wrong = CheckBoard(file.board); !wrong.empty()) {
    throw UserError("board: " + wrong);
  }
  PlaceOnSheet(options, &file);
  return file;
}

}  // namespace glint
