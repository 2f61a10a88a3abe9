// What glint-board prints: planned sheets, their files, and their corners in a raster.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "calib/printing/draw_sheet.h"
#include "calib/printing/drawing.h"
#include "calib/printing/sheet_plan.h"
#include "tests/calib/printing/raster_check.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::TenSheets;

TEST(PlanSheet, TheDefaultIsTheBoardThatInitDescribes) {
  const BoardFile file = PlanSheet({});
  EXPECT_EQ(file.board.squares_x, 13);
  EXPECT_EQ(file.board.squares_y, 17);
  EXPECT_EQ(file.board.square_mm, 15);
  EXPECT_EQ(file.board.marker_mm, 11);
  EXPECT_EQ(file.board.window->first_column, 3);
  EXPECT_EQ(file.board.window->first_row, 5);
  EXPECT_EQ(file.board.window->columns, 7);
  EXPECT_EQ(file.board.window->rows, 7);
  EXPECT_EQ(file.board.ruler->length_mm(), 150);
}

// Everything printed lies on the sheet, inside its margins, and nothing covers anything else.
TEST(PlanSheet, EverySheetHoldsWhatItSays) {
  auto sheets = TenSheets();
  SheetOptions tags;
  tags.kind = "markers";
  tags.squares = {5, 7};
  sheets.push_back({"tags", tags});
  for (const auto& [name, options] : sheets) {
    const BoardFile file = PlanSheet(options);
    ASSERT_EQ(CheckBoard(file.board), "") << name;
    const Eigen::Vector2d& centre = file.sheet->board_centre_mm;
    const BoardRectangle r = OutlineInSample(file.board);
    EXPECT_GE(r.left_mm + centre.x(), options.margin_mm - 1e-9) << name;
    EXPECT_LE(r.right_mm + centre.x(), file.sheet->width_mm - options.margin_mm + 1e-9) << name;
    EXPECT_LE(r.top_mm + centre.y(), file.sheet->height_mm - options.margin_mm + 1e-9) << name;
    ASSERT_TRUE(file.board.ruler) << name;
    EXPECT_LT(file.board.ruler->from_in_board_mm.y() + 5, r.bottom_mm) << name;
    EXPECT_LE(file.board.ruler->to_in_board_mm.x() + centre.x(), file.sheet->width_mm) << name;
    for (const BoardPatch& patch : file.board.patches) {
      EXPECT_GT(patch.in_board.bottom_mm, r.top_mm) << name;
      EXPECT_LE(patch.in_board.top_mm + centre.y(), file.sheet->height_mm) << name;
    }
    if (!options.sample_mm.empty()) {
      const BoardRectangle opening = *OpeningInSample(file.board);
      EXPECT_GE(opening.right_mm - opening.left_mm, options.sample_mm[0]) << name;
      EXPECT_GE(opening.top_mm - opening.bottom_mm, options.sample_mm[1]) << name;
    }
    const Drawing drawing = DrawSheet(file, options.paper_reflectance);
    for (const TextLine& line : drawing.lines) {
      EXPECT_LE(line.start_mm.x() + line.size_mm * TextWidth(line.text), file.sheet->width_mm)
          << name << ": " << line.text;
    }
  }
}

TEST(PlanSheet, PatchesRecordWhatThePrinterIsTold) {
  SheetOptions options;
  options.patches = {0.85, 0.18, 0};
  const Board board = PlanSheet(options).board;
  EXPECT_EQ(board.patches[0].reflectance, 0.85);
  EXPECT_NEAR(board.patches[1].reflectance, 0.18, 0.002);
  EXPECT_EQ(board.patches[2].reflectance, 0);
  for (int level = 0; level < 256; ++level) {
    if (level <= 3) continue;  // below what four digits tell
    EXPECT_EQ(LevelOfReflectance(ReflectanceOfLevel(level, 0.85), 0.85), level);
  }
}

TEST(PlanSheet, SaysWhatDoesNotFit) {
  const auto complaint = [](auto change) {
    SheetOptions options;
    change(&options);
    return test::MessageOf<UserError>([&] { PlanSheet(options); });
  };
  EXPECT_THAT(complaint([](SheetOptions* o) { o->paper = "B4"; }),
              AllOf(HasSubstr("--paper: found 'B4'"), HasSubstr("Letter")));
  EXPECT_THAT(complaint([](SheetOptions* o) { o->paper = "100x"; }), HasSubstr("'100x'"));
  EXPECT_THAT(complaint([](SheetOptions* o) { o->paper = "30x30"; }), HasSubstr("larger"));
  EXPECT_THAT(complaint([](SheetOptions* o) {
                o->sample_mm = {180, 180};
              }),
              AllOf(HasSubstr("--sample-mm"), HasSubstr("13 x 17")));
  EXPECT_THAT(complaint([](SheetOptions* o) {
                o->squares = {20, 20};
                o->square_mm = 15;
              }),
              AllOf(HasSubstr("room for 195.0"), HasSubstr("300.0")));
  EXPECT_THAT(complaint([](SheetOptions* o) { o->marker_mm = 16; }), HasSubstr("marker_mm"));
  EXPECT_THAT(complaint([](SheetOptions* o) { o->dictionary = "DICT_4X4_50"; }),
              HasSubstr("need 110"));
  EXPECT_THAT(complaint([](SheetOptions* o) { o->squares = {5}; }), HasSubstr("found 1 numbers"));
  EXPECT_THAT(complaint([](SheetOptions* o) { o->patches = {0.9}; }), HasSubstr("0.85"));
}

TEST(PrintedFiles, AreTheSameEachTimeAndTellAPersonWhatTheyAre) {
  const BoardFile file = PlanSheet({});
  const std::string pdf = PdfOf(DrawSheet(file, 0.85)), svg = SvgOf(DrawSheet(file, 0.85));
  EXPECT_EQ(pdf, PdfOf(DrawSheet(file, 0.85)));
  for (const std::string& text : {pdf, svg}) {
    EXPECT_THAT(text, HasSubstr("13 x 17 squares of 15 mm"));
    EXPECT_THAT(text, HasSubstr("Print at 100 %"));
    EXPECT_THAT(text, HasSubstr("150 mm"));
    EXPECT_THAT(text, Not(HasSubstr("Date")));
  }
  EXPECT_THAT(pdf, HasSubstr("/PrintScaling /None"));
  EXPECT_THAT(pdf, HasSubstr("/MediaBox [0 0 595.27559 841.88976]"));
  EXPECT_THAT(svg, HasSubstr("width=\"210mm\" height=\"297mm\" viewBox=\"0 0 210 297\""));
}

TEST(PrintedFiles, CornersOfTheRasterAreWhereTheDescriptionHasThem) {
  const test::TemporaryFolder folder;
  const auto sheets = TenSheets();
  const auto check = [&](size_t index, int dpi, const std::string& program) {
    const BoardFile file = PlanSheet(sheets[index].options);
    WriteFileAtomically(folder / "board.pdf", PdfOf(DrawSheet(file, 0.85)));
    const auto raster = testing::Rasterize(folder / "board.pdf", dpi, program);
    const auto errors = testing::CheckCorners(file, raster, dpi);
    fmt::print("{} at {} dpi by {}: {} of {} corners, RMS {:.4f} px, worst {:.4f} px\n",
               sheets[index].name, dpi, program, errors.found, errors.corners, errors.rms_px,
               errors.worst_px);
    EXPECT_EQ(errors.found, errors.corners);
    return errors;
  };
  // The others are bench_printing's.
  for (const auto& [index, dpi] : {std::pair{1, 150}, {3, 300}, {4, 600}, {9, 150}}) {
    EXPECT_LE(check(index, dpi, "pdftocairo").worst_px, 0.05);
  }
  // An eighth of a pixel in each direction is its own.
  EXPECT_LE(check(4, 300, "pdftoppm").worst_px, 0.05 + 0.18);
}

TEST(PrintedFiles, TheSvgIsWellFormed) {
  const test::TemporaryFolder folder;
  WriteFileAtomically(folder / "board.svg", SvgOf(DrawSheet(PlanSheet({}), 0.85)));
  const std::string command =
      "python3 -c \"import sys, xml.dom.minidom as m; "
      "m.parse(sys.argv[1])\" " +
      (folder / "board.svg").string();
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace glint
