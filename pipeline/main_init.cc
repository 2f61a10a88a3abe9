// glint-init: writes a capture.toml.
#include "pipeline/contract/program.h"
#include "pipeline/driver/init.h"

namespace {

void AddOptions(glint::OptionSet* options, glint::InitOptions* o) {
  options->AddPositional("DIR", &o->folder, "the capture's folder", false);
  options->AddChoice("board", &o->board, {"charuco", "checkerboard"}, "kind of board");
  options->Add("squares", &o->squares, "COLUMNS,ROWS of squares");
  options->AddRange("square-mm", &o->square_mm, 0.1, 1000, "side of a square");
  options->AddRange("marker-mm", &o->marker_mm, 0.1, 1000, "side of a ChArUco marker");
  options->Add("dictionary", &o->dictionary, "OpenCV's name of the ArUco dictionary");
  options->Add("window", &o->window,
               "FIRST_COLUMN,FIRST_ROW,COLUMNS,ROWS of squares left out for the sample");
  options->Add("full-board", &o->full_board, "no window");
  options->Add("sample-mm", &o->sample_mm, "WIDTH,HEIGHT of the sample");
  options->AddRange("resolution", &o->resolution_px, 8, 16384, "width of the maps in texels");
  options->AddChoice("encoding", &o->encoding, {"auto", "srgb", "gamma2.2", "linear"},
                     "how the photographs store radiance");
  options->Add("light-offset-mm", &o->light_offset_mm,
               "X,Y,Z of the flash in the camera frame: x right, y down, z forward");
}

}  // namespace

int main(int argc, char** argv) {
  glint::InitOptions o;
  glint::OptionSet options;
  AddOptions(&options, &o);
  return glint::RunProgram(
      argc, argv,
      {"glint-init", "Writes a commented capture.toml, never over one that is there.",
       GLINT_VERSION,
       "A board.json in the folder (glint board) is taken for the board; else the options describe "
       "it.\nExample: glint init wood --squares 12,12 --square-mm 15 --sample-mm 100,100"},
      &options, [&](const glint::CommonOptions&) -> glint::ProgramResult {
        const glint::InitResult result = glint::WriteCapture(o);
        return {result.BriefReport(),
                {{"file", result.file.generic_string()},
                 {"photos", result.photos},
                 {"board_photos", result.board_photos}}};
      });
}
