// What glint-board prints: planned sheets, their files, and their corners in a raster.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "base/board/board_kind.h"
#include "base/errors/errors.h"
#include "base/files/files.h"
#include "calib/corners/detector.h"
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

// The sheet as BoardPainter has it, from above; grey levels as a camera writes them.
GrayImage PictureOf(const BoardFile& file, int dpi) {
  const double pixel_mm = 25.4 / dpi;
  GrayImage picture;
  picture.width = static_cast<int>(file.sheet->width_mm / pixel_mm);
  picture.height = static_cast<int>(file.sheet->height_mm / pixel_mm);
  const BoardPainter painter(file.board, 1000);
  constexpr int kSamples = 6;  // a side of a lens's blur, which is two pixels wide
  for (int i = 0; i < picture.width * picture.height; ++i) {
    double sum = 0;
    for (int k = 0; k < kSamples * kSamples; ++k) {
      const double x = i % picture.width - 0.5 + 2 * (k % kSamples + 0.5) / kSamples;
      const double y = i / picture.width - 0.5 + 2 * (k / kSamples + 0.5) / kSamples;
      const Eigen::Vector2d at = Eigen::Vector2d(x, -y) * pixel_mm +
                                 Eigen::Vector2d(0, file.sheet->height_mm) -
                                 file.sheet->board_centre_mm;
      sum += painter.ReflectanceAt(at.x(), at.y()).value_or(1);
    }
    const double share = sum / (kSamples * kSamples);
    picture.samples.push_back(
        static_cast<unsigned char>(std::lround(255 * std::pow(share, 1 / 2.2))));
  }
  return picture;
}

// ScaleBoard scales every length: at twice the size, corners and ink lie twice as far from the
// board's centre.
void ExpectScalesAsAWhole(const Board& board) {
  Board twice = board;
  ScaleBoard(2, &twice);
  const Eigen::Vector2d& centre = board.board_centre_in_sample_mm;
  const auto scaled = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    return centre + 2 * (p - centre);
  };
  const std::vector<BoardCorner> corners = BoardCorners(board), moved = BoardCorners(twice);
  ASSERT_EQ(moved.size(), corners.size());
  for (size_t i = 0; i < corners.size(); ++i) {
    EXPECT_EQ(moved[i].id, corners[i].id);
    EXPECT_LT((moved[i].position_in_sample_mm - scaled(corners[i].position_in_sample_mm)).norm(),
              1e-9);
  }
  const BoardRectangle outline = OutlineInSample(board);
  const BoardPainter painter(board, 0), painter_of_twice(twice, 0);
  constexpr int kPoints = 400;  // a side
  int differ = 0;
  for (int i = 0; i < kPoints * kPoints; ++i) {
    const double across = (i % kPoints + 0.5) / kPoints, up = (i / kPoints + 0.5) / kPoints;
    const Eigen::Vector2d p(std::lerp(outline.left_mm, outline.right_mm, across),
                            std::lerp(outline.bottom_mm, outline.top_mm, up));
    const Eigen::Vector2d q = scaled(p);
    differ += painter.ReflectanceAt(p.x(), p.y()) != painter_of_twice.ReflectanceAt(q.x(), q.y());
  }
  EXPECT_LE(differ, kPoints * kPoints / 10000) << "at edges";
}

// A kind that is added to the list fails here until its description, its sheet and its detector
// exist and agree.
TEST(BoardKinds, EachIsPlannedDescribedReadBackAndFound) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "board_kinds";
  std::filesystem::create_directories(folder);
  for (const BoardKind kind : BoardKinds()) {
    SheetOptions options;
    options.kind = KindOf(kind).name();
    const BoardFile planned = PlanSheet(options);
    ASSERT_EQ(planned.board.kind, kind);
    WriteFileAtomically(folder / "board.json", ToJson(planned).dump());
    const BoardFile read = ReadBoardFile(folder / "board.json");
    EXPECT_EQ(ToJson(read), ToJson(planned)) << options.kind;
    EXPECT_EQ(BoardInWords(read.board), BoardInWords(planned.board));
    EXPECT_EQ(KindOf(kind).InOneLine(read.board), KindOf(kind).InOneLine(planned.board));
    EXPECT_FALSE(PaperSpots(read.board).empty()) << options.kind;
    ExpectScalesAsAWhole(read.board);
    constexpr int kDpi = 110;
    const BoardDetection found = DetectBoard(PictureOf(read, kDpi), read.board);
    EXPECT_EQ(found.corners.size(), BoardCorners(read.board).size()) << found.problem;
    for (const CornerObservation& corner : found.corners) {
      const Eigen::Vector2d at = corner.position_in_sample_mm + read.sheet->board_centre_mm;
      const Eigen::Vector2d expected =
          Eigen::Vector2d(at.x(), read.sheet->height_mm - at.y()) * (kDpi / 25.4);
      EXPECT_LT((corner.point_px - expected).norm(), 0.3) << options.kind << " " << corner.id;
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
