// glint-init: writes a capture.toml.
#include "base/board/board_kind.h"
#include "base/programs/program.h"
#include "calib/moving_light/lights_file.h"
#include "calib/triage/list_photos.h"
#include "pipeline/driver/init.h"

namespace {

void AddOptions(glint::OptionSet* options, glint::InitOptions* o) {
  options->AddPositional("DIR", &o->folder, "the capture's folder", false);
  options->Add("create", &o->create, "make the folder if it does not exist");
  std::vector<std::string> boards = glint::BoardKindNames(true);
  boards.emplace_back("none");
  options->AddChoice("board", &o->board, boards,
                     "kind of board; none: COLMAP estimates the cameras");
  options->Add("squares", &o->squares, "COLUMNS,ROWS of squares");
  options->AddRange("square-mm", &o->square_mm, 0.1, 1000, "side of a square");
  options->AddRange("marker-mm", &o->marker_mm, 0.1, 1000, "side of a ChArUco marker");
  options->Add("dictionary", &o->dictionary, "OpenCV's name for the ArUco dictionary");
  options->Add("window", &o->window,
               "FIRST_COLUMN,FIRST_ROW,COLUMNS,ROWS of squares left out for the sample");
  options->Add("full-board", &o->full_board, "the board has no window");
  options->Add("sample-mm", &o->sample_mm, "WIDTH,HEIGHT of the sample");
  options->AddRange(
      "resolution", &o->resolution_px, 0, 16384,
      "width of the maps in texels; 0: 1024, or with --lights the picture's width, at most 2048");
  options->Add("encoding", &o->encoding,
               "encoding of the photographs: auto, srgb, gamma2.2, linear, or the path of "
               "a response-curve file (as written by glint-response)");
  options->AddRange("every", &o->every, 1, 1000000, "use every Nth frame of a video");
  options->Add("single", &o->single,
               "one photograph from directly above, without a board; requires --width-mm or "
               "--distance-mm");
  options->AddRange("width-mm", &o->width_mm, 0, 1e5,
                    "with --single or --lights: width of the area that the picture shows");
  options->AddRange("distance-mm", &o->distance_mm, 0, 1e5,
                    "with --single: distance from the lens to the sample");
  options->Add("lights", &o->lights,
               "fixed camera and moving light (RTI): file with the lights' directions or positions "
               "(" +
                   glint::LightsFileEndings() +
                   "), inside DIR; requires --width-mm or --sample-mm");
  options->Add(
      "balls-px", &o->balls_px,
      "the same, without such a file: X,Y of three points on the rim of a reflective ball in "
      "the photographs (for two balls, six points)");
  options->Add("light-offset-mm", &o->light_offset_mm,
               "X,Y,Z of the flash in the camera frame: x right, y down, z forward");
}

}  // namespace

int main(int argc, char** argv) {
  glint::InitOptions o;
  bool list = false;
  glint::OptionSet options;
  AddOptions(&options, &o);
  options.Add("list", &list,
              "write nothing; list what is read from each photograph in the folder (EXIF, size)");
  return glint::RunProgram(
      argc, argv,
      {"glint-init", "Writes a commented capture.toml. Never overwrites an existing one.",
       GLINT_VERSION,
       "If the folder contains a board.json (glint board), it defines the board; otherwise the "
       "options do.\nExamples:\n  glint init wood --squares 12,12 --square-mm "
       "15 --sample-mm 90,90\n"
       "  glint init wood --single --width-mm 120\n"
       "  glint init icon --lights icon/dirs.lp --width-mm 180\n"
       "  glint init wood --list",
       false},
      &options, [&](const glint::CommonOptions&) -> glint::ProgramResult {
        if (list) {
          const auto photos = glint::ListPhotos(o.folder);
          return {glint::TableOf(photos), glint::ToJson(photos)};
        }
        const glint::InitResult result = glint::WriteCapture(o);
        return {result.BriefReport(),
                {{"file", result.file.generic_string()},
                 {"photos", result.photos},
                 {"board_photos", result.board_photos}}};
      });
}
