// `glint init`: a commented capture.toml for a folder of photographs. A board.json in the folder,
// as `glint board` writes it, is taken for the board; else the options describe it, or say that
// there is none.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace glint {

struct InitOptions {
  std::filesystem::path folder = ".";
  bool create = false;            // the folder, where there is none
  std::string board = "charuco";  // or "checkerboard"; "none": poses come from COLMAP
  std::vector<double> squares = {13, 17};
  double square_mm = 15;
  double marker_mm = 11;  // charuco only
  std::string dictionary = "DICT_5X5_1000";
  std::vector<double> window;  // first column, first row, columns, rows; empty: in the middle
  bool full_board = false;     // no window: the sample lies on or beside a whole board
  std::vector<double>
      sample_mm;  // width, height; empty: the window less a margin, 100 mm without a board
  // Width of the maps; 0: 1024, of a fixed camera as many as the picture has pixels, up to 2048.
  int resolution_px = 0;
  std::string encoding = "auto";  // or a response curve's file (.json)
  int every = 15;                 // of a video's frames, one in so many
  std::vector<double> light_offset_mm = {0, 0, 0};
  // One photograph from straight above, without a board.
  bool single = false;
  double width_mm = 0;     // how much of the sample's plane the picture's width shows, or …
  double distance_mm = 0;  // … the lens's height above it
  // A camera that stands still and a light that moves: the file of its directions, or points on the
  // rim of reflecting balls in the photographs (x, y of three; six for two balls).
  std::filesystem::path lights;
  std::vector<double> balls_px;
  bool fixed_camera() const { return !lights.empty() || !balls_px.empty(); }
};

struct InitResult {
  std::filesystem::path file;
  size_t photos = 0, board_photos = 0;
  bool has_board = true, single = false, fixed_camera = false;
  bool size_assumed = false;  // of a fixed camera's picture
  std::string BriefReport() const;
};

// The text that WriteCapture writes. Throws UserError for options that describe no board.
std::string CaptureText(const InitOptions& options, InitResult* result);

// Writes folder/capture.toml; never over one that is there, nor for a sample that does not fit the
// board's window (UserError).
InitResult WriteCapture(const InitOptions& options);

}  // namespace glint
