// Single markers at listed places round the sample.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "base/board/board_kind.h"
#include "base/board/dictionary.h"
#include "base/board/marker_ink.h"
#include "base/board/wrong_field.h"

namespace glint {
namespace {

constexpr size_t kMostMarkers = 1000;  // keeps memory bounded whatever a description says
constexpr double kMost_mm = 1e5;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::string CheckCorners(const ListedMarker& marker, const std::string& field) {
  double shortest = 1e300, longest = 0;
  int clockwise = 0, counter = 0;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d& a = marker.corners_in_board_mm[k];
    const Eigen::Vector2d& b = marker.corners_in_board_mm[(k + 1) % 4];
    const Eigen::Vector2d& c = marker.corners_in_board_mm[(k + 2) % 4];
    if (!a.allFinite() || !(a.cwiseAbs().maxCoeff() < kMost_mm)) {
      return WrongField(field, "a corner out of range", "give millimetres below 100000");
    }
    shortest = std::min(shortest, (b - a).norm());
    longest = std::max(longest, (b - a).norm());
    (Cross(b - a, c - b) < 0 ? clockwise : counter) += 1;
  }
  if (counter == 4) {
    return WrongField(field, "corners listed anticlockwise",
                      "list them clockwise as seen from the front, from the marker's own top left "
                      "(y points up; AprilTag's own program lists them the other way round)");
  }
  if (clockwise != 4 || !(shortest > 0.05 * longest)) {
    return WrongField(field, "corners that do not form a square",
                      "list the four corners in turn, clockwise from the marker's own top left");
  }
  return "";
}

bool Inside(const BoardRectangle& r, const Eigen::Vector2d& p) {
  return p.x() > r.left_mm && p.x() < r.right_mm && p.y() > r.bottom_mm && p.y() < r.top_mm;
}

std::string CheckOpening(const Board& board) {
  const BoardRectangle& r = *board.opening_in_board;
  const std::string found =
      fmt::format("[{}, {}, {}, {}]", r.left_mm, r.bottom_mm, r.right_mm, r.top_mm);
  if (!(r.left_mm < r.right_mm) || !(r.bottom_mm < r.top_mm)) {
    return WrongField("opening_mm", found, "give [left, bottom, right, top] in millimetres");
  }
  for (const ListedMarker& marker : board.markers) {
    for (const Eigen::Vector2d& corner : marker.corners_in_board_mm) {
      if (!Inside(r, corner)) continue;
      return WrongField(
          "opening_mm", found,
          fmt::format("marker {} lies in it; give the hole in which the sample lies", marker.id));
    }
  }
  return "";
}

std::string CheckFrame(const Board& board) {
  if (!DictionaryNumber(board.dictionary)) {
    return WrongField("dictionary", "\"" + board.dictionary + "\"",
                      fmt::format("use tag16h5, tag25h9, tag36h10, tag36h11 or one of {}",
                                  fmt::join(DictionaryNames(), ", ")));
  }
  if (board.markers.size() < 2 || board.markers.size() > kMostMarkers) {
    return WrongField("markers", fmt::format("{} of them", board.markers.size()),
                      fmt::format("list 2 to {}", kMostMarkers));
  }
  const int size = DictionarySize(board.dictionary);
  std::set<int> ids;
  for (size_t i = 0; i < board.markers.size(); ++i) {
    const ListedMarker& marker = board.markers[i];
    const std::string field = fmt::format("markers[{}]", i);
    if (marker.id < 0 || marker.id >= size) {
      return WrongField(field + ".id", std::to_string(marker.id),
                        fmt::format("{} has ids from 0 to {}", board.dictionary, size - 1));
    }
    if (!ids.insert(marker.id).second) {
      return WrongField(field + ".id", fmt::format("{} a second time", marker.id),
                        "each marker of a board needs an id of its own");
    }
    if (const std::string wrong = CheckCorners(marker, field); !wrong.empty()) return wrong;
  }
  return board.opening_in_board ? CheckOpening(board) : "";
}

Eigen::Vector2d Point(const std::vector<double>& numbers) { return {numbers[0], numbers[1]}; }

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

// The homography that takes the marker's corners to those of the square (0, 0) … (cells, cells), y
// down: exact for squares, and for the slightly skewed ones of a measured board too.
Eigen::Matrix3d CellsFromSample(const BoardMarker& marker, int cells) {
  Eigen::Matrix<double, 8, 8> a;
  Eigen::Matrix<double, 8, 1> b;
  const double side = cells;
  const Eigen::Vector2d to[4] = {{0, 0}, {side, 0}, {side, side}, {0, side}};
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d& p = marker.corners_in_sample_mm[k];
    a.row(2 * k) << p.x(), p.y(), 1, 0, 0, 0, -p.x() * to[k].x(), -p.y() * to[k].x();
    a.row(2 * k + 1) << 0, 0, 0, p.x(), p.y(), 1, -p.x() * to[k].y(), -p.y() * to[k].y();
    b.segment<2>(2 * k) = to[k];
  }
  const Eigen::Matrix<double, 8, 1> h = a.fullPivLu().solve(b);
  Eigen::Matrix3d matrix;
  matrix << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  return matrix;
}

// White paper outside each side of each marker: markers stand on a rim of white at least a cell
// wide.
std::vector<PaperSpot> SpotsBesideMarkers(const Board& board) {
  std::vector<PaperSpot> spots;
  const auto opening = OpeningInSample(board);
  int block = 0;
  for (const BoardMarker& marker : BoardMarkers(board)) {
    const double cell_mm = board.square_mm / CellsOfMarker(board.dictionary, marker.id).cells;
    Eigen::Vector2d centre(0, 0);
    for (const Eigen::Vector2d& corner : marker.corners_in_sample_mm) centre += 0.25 * corner;
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2d middle =
          0.5 * (marker.corners_in_sample_mm[k] + marker.corners_in_sample_mm[(k + 1) % 4]);
      const Eigen::Vector2d at = middle + 0.5 * cell_mm * (middle - centre).normalized();
      if (opening && at.x() > opening->left_mm - cell_mm && at.x() < opening->right_mm + cell_mm &&
          at.y() > opening->bottom_mm - cell_mm && at.y() < opening->top_mm + cell_mm) {
        continue;
      }
      spots.push_back({SquaresFromSample(board, at), 0.5 * cell_mm / board.square_mm, block});
    }
    ++block;
  }
  return spots;
}

class InkOfFrame : public BoardInk {
 public:
  explicit InkOfFrame(const Board& board) : opening_(OpeningInSample(board)) {
    for (const BoardMarker& marker : BoardMarkers(board)) {
      MarkerCells cells = CellsOfMarker(board.dictionary, marker.id);
      const Eigen::Matrix3d cells_from_sample = CellsFromSample(marker, cells.cells);
      markers_.push_back({cells_from_sample, std::move(cells)});
    }
  }

  std::optional<double> ReflectanceAt(const Eigen::Vector2d& in_sample_mm) const override {
    if (opening_ && InOrOn(*opening_, in_sample_mm)) return std::nullopt;
    for (const PaintedMarker& marker : markers_) {
      const Eigen::Vector3d cell = marker.cells_from_sample * in_sample_mm.homogeneous();
      if (!(cell.z() > 0)) continue;
      const double x = cell.x() / cell.z(), y = cell.y() / cell.z();
      if (!(x >= 0 && y >= 0 && x < marker.cells.cells && y < marker.cells.cells)) continue;
      return PaperAt(marker.cells, x, y);
    }
    return 1.0;
  }

 private:
  static bool InOrOn(const BoardRectangle& r, const Eigen::Vector2d& p) {
    return p.x() >= r.left_mm && p.x() <= r.right_mm && p.y() >= r.bottom_mm && p.y() <= r.top_mm;
  }

  struct PaintedMarker {
    Eigen::Matrix3d cells_from_sample;
    MarkerCells cells;
  };
  std::optional<BoardRectangle> opening_;
  std::vector<PaintedMarker> markers_;
};

class MarkerFrame : public KindOfBoard {
 public:
  const char* name() const override { return "markers"; }
  const char* summary() const override { return "individual AprilTags around the sample"; }
  bool fits_capture_toml() const override { return false; }

  Board Read(JsonObject* object) const override {
    const std::string dictionary =
        DictionaryFromAnyName(object->Text("dictionary", "name it, for example \"tag36h11\""));
    const Json& list = object->Array("markers", 0, "list the markers");
    std::vector<ListedMarker> markers;
    for (std::size_t i = 0; i < list.size(); ++i) {
      markers.push_back(MarkerIn(object->Element("markers", i)));
    }
    Board board = MakeMarkerBoard(dictionary, std::move(markers));
    if (!object->Has("opening_mm")) return board;
    const std::string remedy = "give [left, bottom, right, top] in millimetres";
    const auto n = object->Numbers("opening_mm", 4, remedy);
    if (!(n[0] < n[2]) || !(n[1] < n[3])) object->Reject("opening_mm", remedy);
    board.opening_in_board = BoardRectangle{n[0], n[1], n[2], n[3]};
    return board;
  }

  void Write(const Board& board, Json* json) const override {
    (*json)["dictionary"] = board.dictionary;
    (*json)["markers"] = Json::array();
    for (const ListedMarker& marker : board.markers) {
      Json corners = Json::array();
      for (const Eigen::Vector2d& corner : marker.corners_in_board_mm) {
        corners.push_back(Json::array({corner.x(), corner.y()}));
      }
      (*json)["markers"].push_back({{"id", marker.id}, {"corners_mm", corners}});
    }
    if (!board.opening_in_board) return;
    const BoardRectangle& r = *board.opening_in_board;
    (*json)["opening_mm"] = {r.left_mm, r.bottom_mm, r.right_mm, r.top_mm};
  }

  std::string Check(const Board& board) const override { return CheckFrame(board); }
  std::string InWords(const Board& board) const override {
    return fmt::format("{} markers of {} with sides of {:.6g} mm", board.markers.size(),
                       board.dictionary, board.square_mm);
  }
  std::string InOneLine(const Board& board) const override {
    return fmt::format("{} markers of {}, {} mm on average", board.markers.size(), board.dictionary,
                       board.square_mm);
  }

  BoardRectangle Outline(const Board& board) const override {
    Eigen::Vector2d low(1e300, 1e300), high = -low;
    for (const ListedMarker& marker : board.markers) {
      for (const Eigen::Vector2d& corner : marker.corners_in_board_mm) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
    }
    return InSample(board, {low.x(), low.y(), high.x(), high.y()});
  }
  std::optional<BoardRectangle> Opening(const Board& board) const override {
    if (!board.opening_in_board) return std::nullopt;
    return InSample(board, *board.opening_in_board);
  }
  bool LooksTheSameUpsideDown(const Board&) const override { return false; }

  std::vector<BoardCorner> Corners(const Board& board) const override {
    std::vector<BoardCorner> corners;
    for (const BoardMarker& marker : Markers(board)) {
      for (int k = 0; k < 4; ++k) {
        corners.push_back({4 * marker.id + k, marker.corners_in_sample_mm[k]});
      }
    }
    return corners;
  }
  std::vector<BoardMarker> Markers(const Board& board) const override {
    std::vector<BoardMarker> markers;
    for (const ListedMarker& listed : board.markers) {
      BoardMarker marker;
      marker.id = listed.id;
      for (int k = 0; k < 4; ++k) {
        marker.corners_in_sample_mm[k] =
            listed.corners_in_board_mm[k] + board.board_centre_in_sample_mm;
      }
      markers.push_back(marker);
    }
    return markers;
  }

  std::vector<PaperSpot> Paper(const Board& board) const override {
    return SpotsBesideMarkers(board);
  }
  std::unique_ptr<const BoardInk> Ink(const Board& board) const override {
    return std::make_unique<InkOfFrame>(board);
  }
  std::vector<InkShape> Shapes(const Board& board) const override {
    std::vector<InkShape> shapes;
    for (const BoardMarker& marker : Markers(board)) {
      shapes.push_back(ShapeOfMarker(board.dictionary, marker));
    }
    return shapes;
  }
};

}  // namespace

Board MakeMarkerBoard(const std::string& dictionary, std::vector<ListedMarker> markers) {
  Board board;
  board.kind = BoardKind::kMarkers;
  board.dictionary = dictionary;
  double sides = 0;
  for (const ListedMarker& marker : markers) {
    for (int k = 0; k < 4; ++k) {
      sides += (marker.corners_in_board_mm[(k + 1) % 4] - marker.corners_in_board_mm[k]).norm();
    }
  }
  board.square_mm = markers.empty() ? 0 : sides / (4.0 * static_cast<double>(markers.size()));
  board.markers = std::move(markers);
  return board;
}

const KindOfBoard& MarkerFrameKind() {
  static const MarkerFrame kind;
  return kind;
}

}  // namespace glint
