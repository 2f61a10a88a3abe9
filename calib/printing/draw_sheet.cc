#include "calib/printing/draw_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/board/board_kind.h"
#include "calib/printing/sheet_plan.h"

namespace glint {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

constexpr double kLine_mm = 0.2;

class SheetPen {
 public:
  SheetPen(const BoardFile& file, Drawing* drawing)
      : board_(file.board),
        // Board coordinates and the sample's differ where the file places a sample; sheets do not.
        origin_(file.sheet->board_centre_mm - file.board.board_centre_in_sample_mm),
        drawing_(drawing) {}

  Eigen::Vector2d OnSheet(const Eigen::Vector2d& in_sample_mm) const {
    return in_sample_mm + origin_;
  }
  Polygon Box(const BoardRectangle& r) const {
    const Eigen::Vector2d low = OnSheet({r.left_mm, r.bottom_mm});
    const Eigen::Vector2d high = OnSheet({r.right_mm, r.top_mm});
    return Rectangle(low.x(), low.y(), high.x(), high.y());
  }

  // What is black of the board.
  void Ink() {
    for (const InkShape& shape : KindOf(board_.kind).Shapes(board_)) {
      FilledShape black;
      for (const Polygon& polygon : shape) {
        Polygon& on_sheet = black.polygons.emplace_back();
        for (const Eigen::Vector2d& corner : polygon) on_sheet.push_back(OnSheet(corner));
      }
      drawing_->shapes.push_back(black);
    }
  }

  // A thin grey line just inside the rectangle.
  void Outline(const BoardRectangle& r, int level) {
    const auto l = Box(r);
    const double x0 = l[0].x(), y0 = l[0].y(), x1 = l[2].x(), y1 = l[2].y();
    drawing_->shapes.push_back(
        {{Rectangle(x0, y0, x1, y0 + kLine_mm), Rectangle(x0, y1 - kLine_mm, x1, y1),
          Rectangle(x0, y0, x0 + kLine_mm, y1), Rectangle(x1 - kLine_mm, y0, x1, y1)},
         level});
  }

  void Patches(double paper_reflectance) {
    for (const BoardPatch& patch : board_.patches) {
      const int level = LevelOfReflectance(patch.reflectance, paper_reflectance);
      const BoardRectangle r = InSample(board_, patch.in_board);
      drawing_->shapes.push_back({{Box(r)}, level});
      if (level > 230) Outline(r, 200);
      Text(OnSheet({r.left_mm + 1, r.bottom_mm - 2.8}), 2.2,
           fmt::format("{:.3g}", patch.reflectance));
    }
  }

  // Blocks of a centimetre with edges at both ends, and ticks each millimetre above them.
  void Ruler() {
    if (!board_.ruler) return;
    const Eigen::Vector2d from =
        OnSheet(board_.ruler->from_in_board_mm + board_.board_centre_in_sample_mm);
    const double length = board_.ruler->length_mm();
    constexpr double kHeight = 2.2;
    FilledShape black;
    for (int i = 0; 10 * i < length - 1e-6; i += 2) {
      black.polygons.push_back(Rectangle(from.x() + 10 * i, from.y(),
                                         from.x() + std::min(10.0 * i + 10, length),
                                         from.y() + kHeight));
    }
    for (const double y : {from.y(), from.y() + kHeight - kLine_mm}) {
      black.polygons.push_back(Rectangle(from.x(), y, from.x() + length, y + kLine_mm));
    }
    black.polygons.push_back(
        Rectangle(from.x() + length - kLine_mm, from.y(), from.x() + length, from.y() + kHeight));
    for (int i = 0; i <= length + 1e-6; ++i) {
      const double tick = i % 10 == 0 ? 2.6 : (i % 5 == 0 ? 1.8 : 1.0);
      // The first and the last lie inside the ruler's ends.
      const double x = std::clamp(from.x() + i - 0.05, from.x(), from.x() + length - 0.1);
      black.polygons.push_back(
          Rectangle(x, from.y() + kHeight, x + 0.1, from.y() + kHeight + tick));
    }
    drawing_->shapes.push_back(black);
    Text({from.x() + length + 1.5, from.y()}, 2.6, fmt::format("{:.6g} mm", length));
  }

  void Text(const Eigen::Vector2d& at, double size_mm, const std::string& text) {
    drawing_->lines.push_back({at, size_mm, text});
  }

 private:
  const Board& board_;
  Eigen::Vector2d origin_;
  Drawing* drawing_;
};

// Two lines below the ruler, as large as the sheet's width lets them be.
void WriteText(const BoardFile& file, SheetPen* pen) {
  std::string first = "Glint board: " + BoardInWords(file.board) + ".";
  std::string second = "Print at 100 % (actual size, not fitted to the page).";
  double left = 8, base = 8;
  if (file.board.ruler) {
    const Eigen::Vector2d from =
        pen->OnSheet(file.board.ruler->from_in_board_mm + file.board.board_centre_in_sample_mm);
    left = from.x();
    base = from.y() - 8;
    second += fmt::format(
        " Measure the ruler: if it is not {:.6g} mm long, tell glint board --measured LENGTH.",
        file.board.ruler->length_mm());
  }
  const double room = file.sheet->width_mm - 2 * left;
  const double size = std::clamp(room / std::max(TextWidth(first), TextWidth(second)), 0.8, 2.8);
  pen->Text({left, base + 4.2}, size, first);
  pen->Text({left, base + 0.6}, size, second);
}

}  // namespace

Drawing DrawSheet(const BoardFile& file, double paper_reflectance) {
  Drawing drawing;
  drawing.width_mm = file.sheet->width_mm;
  drawing.height_mm = file.sheet->height_mm;
  drawing.title = "Glint board: " + BoardInWords(file.board);
  SheetPen pen(file, &drawing);
  pen.Ink();
  if (const auto opening = OpeningInSample(file.board)) {
    pen.Outline(*opening, 170);
    const Eigen::Vector2d at = pen.OnSheet({opening->left_mm + 3, opening->top_mm - 6});
    const std::string text = "Cut out along this line: the sample goes in here.";
    const double room = opening->right_mm - opening->left_mm - 6;
    pen.Text(at, std::clamp(room / TextWidth(text), 0.5, 3.0), text);
  }
  pen.Patches(paper_reflectance);
  pen.Ruler();
  WriteText(file, &pen);
  return drawing;
}

}  // namespace glint
