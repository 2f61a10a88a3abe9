// What goes where on a sheet of paper: a board as large as it can be, its ruler, its patches.
#pragma once

#include <string>
#include <vector>

#include "base/formats/board_file.h"

namespace glint {

struct SheetOptions {
  std::string kind = "charuco";  // checkerboard, markers
  std::string paper = "A4";  // A0 … A6, Letter, Legal, Tabloid, or WIDTHxHEIGHT in millimetres
  bool landscape = false;
  double margin_mm = 7.5;  // most printers cannot print nearer to the edge
  // Columns and rows of squares (markers: across and down the frame); empty: as many as fit.
  std::vector<double> squares;
  double square_mm = 0;  // 0: by the sheet; markers: their side
  double marker_mm = 0;  // ChArUco only; 0: 0.74 of a square, cut to half millimetres
  std::string dictionary = "DICT_5X5_1000";
  bool legacy_layout = false;
  // ChArUco only: first column, first row, columns, rows of the window; empty: by sample_mm.
  std::vector<double> window;
  std::vector<double> sample_mm;  // width, height that the window must take; empty: as init has it
  bool full_board = false;        // no window
  std::vector<double> patches;    // reflectances of grey patches
  double paper_reflectance = 0.85;
};

// The sheet and the board on it, by the options. Throws UserError: an option, what was found, the
// remedy.
BoardFile PlanSheet(const SheetOptions& options);

// Width and height of the paper, in millimetres. Throws UserError: a name that nobody knows.
Eigen::Vector2d PaperSize_mm(const std::string& paper, bool landscape);

// A sheet for a board that was described otherwise, at its designed size. Throws UserError where it
// does not fit.
void PlaceOnSheet(const SheetOptions& options, BoardFile* file);

// The level of 255 that a printer is told for a reflectance, by sRGB's curve, and back.
int LevelOfReflectance(double reflectance, double paper_reflectance);
double ReflectanceOfLevel(int level, double paper_reflectance);

}  // namespace glint
