// Vector drawings of a sheet of paper, and their files.
//
// Written here and not by a library: cairo rounds paths to 1/256 point and draws text with whatever
// fonts the machine has, so that the same board would be another file on another machine. What is
// needed is small: filled paths and lines of text, in millimetres that stand in the file as such.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace glint {

// Everything inside its polygons together is filled at once, so that neighbours leave no seams.
// Points are millimetres from the sheet's bottom left corner, y up.
struct FilledShape {
  std::vector<std::vector<Eigen::Vector2d>> polygons;
  int level = 0;  // of 255, as in a picture: 0 ink, 255 paper
};

struct TextLine {
  Eigen::Vector2d start_mm{0, 0};  // left end of the base line
  double size_mm = 3;
  std::string text;  // ASCII
};

struct Drawing {
  double width_mm = 0, height_mm = 0;
  std::string title;
  std::vector<FilledShape> shapes;  // later ones cover earlier ones
  std::vector<TextLine> lines;
};

std::vector<Eigen::Vector2d> Rectangle(double left, double bottom, double right, double top);

// The width of a line in Helvetica, roughly, per size.
double TextWidth(const std::string& text);

// A PDF 1.6 of one page, its printing preset to actual size; nothing in it depends on time, machine
// or installed fonts.
std::string PdfOf(const Drawing& drawing);
std::string SvgOf(const Drawing& drawing);

}  // namespace glint
