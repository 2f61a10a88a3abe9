// glint-board: a calibration board as PDF and SVG, and its description for calib.
#include <fmt/format.h>

#include <cmath>

#include "base/board/board_kind.h"
#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/board_file.h"
#include "base/programs/program.h"
#include "calib/printing/draw_sheet.h"
#include "calib/printing/drawing.h"
#include "calib/printing/sheet_plan.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

struct BoardOptions {
  fs::path folder = ".";
  SheetOptions sheet;
  fs::path from;        // a board.json to print
  double measured = 0;  // length of the ruler on paper
};

constexpr char kTable[] = "[board]\nfile = \"board.json\"\n";

void WriteDescription(const fs::path& file, const BoardFile& board) {
  WriteFileAtomically(file, ToJson(board).dump(1) + "\n");
}

ProgramResult Correct(const BoardOptions& options) {
  const fs::path file = options.folder / "board.json";
  const fs::path source = options.from.empty() ? file : options.from;
  BoardFile board = ReadBoardFile(source);
  ScaleBoard(RulerFactor(source, board.board, options.measured), &board.board);
  WriteDescription(file, board);
  const double scale = board.board.print_scale;
  std::string text =
      fmt::format("the board was printed at {}\n{} now says so: {}\n",
                  PrintScaleInWords(board.board), file.string(), BoardInWords(board.board));
  if (std::abs(scale - 1) > 0.01) {
    text +=
        "more than 1 % off: the printer fits to the page; its lengths are corrected, but look "
        "whether all of the board is on the paper\n";
  }
  return {text, {{"file", file.string()}, {"print_scale", scale}}};
}

ProgramResult Print(const BoardOptions& options, const CommonOptions& common) {
  const fs::path description = options.folder / "board.json";
  if (fs::exists(description) && !common.force &&
      !(fs::exists(options.from) && fs::equivalent(description, options.from))) {
    throw UserError(description, "", "an existing board.json",
                    "give another folder, or --force to replace it");
  }
  BoardFile board;
  if (options.from.empty()) {
    board = PlanSheet(options.sheet);
  } else {
    board = ReadBoardFile(options.from);
    PlaceOnSheet(options.sheet, &board);
  }
  const Drawing drawing = DrawSheet(board, options.sheet.paper_reflectance);
  std::error_code error;
  fs::create_directories(options.folder, error);
  if (error) {
    throw EnvironmentError(options.folder.string() + ": cannot create the folder: " +
                           error.message() + "; check the path and its permissions");
  }
  WriteFileAtomically(options.folder / "board.pdf", PdfOf(drawing));
  WriteFileAtomically(options.folder / "board.svg", SvgOf(drawing));
  WriteDescription(description, board);
  std::string text = fmt::format("{}: {}\nwrote board.pdf, board.svg and board.json\n",
                                 options.folder.string(), BoardInWords(board.board));
  text += "print board.pdf at 100 %, on stiff, matt paper";
  if (board.board.ruler) {
    text += fmt::format(
        ", and measure its ruler; if that is not {:.6g} mm: glint board {} "
        "--measured LENGTH",
        board.board.ruler->length_mm(), options.folder.string());
  }
  text += "\nin the capture.toml beside a copy of board.json:\n\n" + std::string(kTable);
  Json json = {{"pdf", (options.folder / "board.pdf").string()},
               {"svg", (options.folder / "board.svg").string()},
               {"file", description.string()},
               {"table", kTable},
               {"board", ToJson(board)}};
  return {text, json};
}

// "charuco: a frame with …; checkerboard: …"
std::string KindsInWords() {
  std::string text;
  for (const BoardKind kind : BoardKinds()) {
    const KindOfBoard& row = KindOf(kind);
    text += (text.empty() ? "" : "; ") + std::string(row.name()) + ": " + row.summary();
  }
  return text;
}

void AddOptions(OptionSet* set, BoardOptions* options) {
  SheetOptions& sheet = options->sheet;
  set->AddPositional("DIR", &options->folder, "folder for board.pdf, board.svg, board.json", false);
  set->AddChoice("kind", &sheet.kind, BoardKindNames(), KindsInWords());
  set->Add("paper", &sheet.paper,
           "A0 to A6, Letter, Legal, Tabloid, or WIDTHxHEIGHT in millimetres");
  set->Add("landscape", &sheet.landscape, "the paper's longer side is horizontal");
  set->AddRange("margin-mm", &sheet.margin_mm, 0, 200, "white margin at the paper's edges");
  set->Add("squares", &sheet.squares,
           "COLUMNS,ROWS of squares (--kind markers: the number of markers along the frame's "
           "horizontal and vertical sides); if omitted, as many as fit");
  set->AddRange("square-mm", &sheet.square_mm, 0, 1000,
                "side of a square (--kind markers: of a marker); 0: chosen to fit the paper");
  set->AddRange("marker-mm", &sheet.marker_mm, 0, 1000,
                "side of a ChArUco marker; 0: derived from the square");
  set->Add(
      "dictionary", &sheet.dictionary,
      "marker dictionary, by OpenCV or AprilTag name; with --kind markers the default is tag36h11");
  set->Add("legacy-layout", &sheet.legacy_layout,
           "use the ChArUco layout of OpenCV versions before 4.6");
  set->Add("window", &sheet.window,
           "FIRST_COLUMN,FIRST_ROW,COLUMNS,ROWS of squares left out for the sample");
  set->Add("sample-mm", &sheet.sample_mm, "WIDTH,HEIGHT of the sample that must fit in the window");
  set->Add("full-board", &sheet.full_board, "make a board without a window");
  set->Add("patches", &sheet.patches,
           "reflectances of grey patches above the board, such as 0.85,0.6,0.36,0.18,0.09,0.04");
  set->AddRange("paper-reflectance", &sheet.paper_reflectance, 0.05, 1,
                "reflectance of the white paper");
  set->Add("from", &options->from,
           "use the board described in this board.json instead of designing a new one; with "
           "--measured, correct its description");
  set->AddRange(
      "measured", &options->measured, 0, 1e5,
      "length of the printed ruler in mm: corrects DIR/board.json; no new sheet is written");
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  glint::BoardOptions options;
  glint::OptionSet set;
  glint::AddOptions(&set, &options);
  const glint::ProgramInfo info{
      "glint-board",
      "Makes a calibration board to print: PDF and SVG at true scale, and board.json, which calib "
      "reads.",
      GLINT_VERSION,
      "Examples:\n  glint board wood --sample-mm 100,100\n"
      "  glint board wood --measured 149.2      the printed ruler's length: corrects board.json\n"
      "  glint board a3 --paper A3 --landscape --patches 0.85,0.36,0.18,0.09"};
  return glint::RunProgram(argc, argv, info, &set, [&](const glint::CommonOptions& common) {
    return options.measured > 0 ? glint::Correct(options) : glint::Print(options, common);
  });
}
