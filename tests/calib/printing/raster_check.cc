#include "tests/calib/printing/raster_check.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/errors/errors.h"
#include "calib/corners/saddle.h"

namespace glint::testing {

GrayImage Rasterize(const std::filesystem::path& pdf, int dpi, const std::string& program) {
  const std::string stem = (pdf.parent_path() / pdf.stem()).string();
  const std::string command =
      fmt::format("{} -gray -png -singlefile -r {} '{}' '{}'", program, dpi, pdf.string(), stem);
  if (std::system(command.c_str()) != 0) {
    throw EnvironmentError(program + " failed; apt-get install poppler-utils");
  }
  cv::Mat picture = cv::imread(stem + ".png", cv::IMREAD_GRAYSCALE);
  std::filesystem::remove(stem + ".png");
  if (picture.empty()) throw EnvironmentError(stem + ".png: no picture");
  // Edges as sharp as a pixel's box are up to 0.05 px off the fit's model; a lens's are not.
  cv::GaussianBlur(picture, picture, {0, 0}, 1.0);
  return {picture.cols, picture.rows,
          std::vector<unsigned char>(picture.datastart, picture.dataend)};
}

RasterErrors CheckCorners(const BoardFile& file, const GrayImage& raster, int dpi) {
  const double px_per_mm = dpi / 25.4;
  const double square_px = file.board.square_mm * px_per_mm;
  const double gap = 0.5 * (1 - file.board.marker_mm / file.board.square_mm);
  RasterErrors errors;
  double squares = 0;
  for (const BoardCorner& corner : BoardCorners(file.board)) {
    const Eigen::Vector2d on_sheet_mm = corner.position_in_sample_mm + file.sheet->board_centre_mm;
    SaddleGuess guess;
    guess.centre_px = {on_sheet_mm.x() * px_per_mm,
                       (file.sheet->height_mm - on_sheet_mm.y()) * px_per_mm};
    guess.column_px = {square_px, 0};
    guess.row_px = {0, square_px};
    const int column = corner.id % (file.board.squares_x - 1);
    const int row = corner.id / (file.board.squares_x - 1);
    guess.top_left_is_black = SquareIsBlack(file.board, column, row);
    guess.radius_squares = std::min(0.42, 1.3 * gap);
    const SaddleFit fit = FitSaddle(raster, guess, {});
    ++errors.corners;
    if (!fit.ok) continue;
    ++errors.found;
    const double error = (fit.centre_px - guess.centre_px).norm();
    squares += error * error;
    errors.worst_px = std::max(errors.worst_px, error);
  }
  errors.rms_px = std::sqrt(squares / std::max(1, errors.found));
  return errors;
}

std::vector<NamedSheet> TenSheets() {
  std::vector<NamedSheet> sheets;
  const auto add = [&](const std::string& name, const std::string& paper) -> SheetOptions& {
    sheets.push_back({name, {}});
    sheets.back().options.paper = paper;
    return sheets.back().options;
  };
  add("A4, as it comes", "A4");
  SheetOptions& across = add("A4 across, sample 100 x 80, patches", "A4");
  across.landscape = true;
  across.sample_mm = {100, 80};
  across.patches = {0.85, 0.6, 0.36, 0.18, 0.09, 0.04};
  add("A3, squares of 17.3 mm", "A3").square_mm = 17.3;
  add("A5", "A5");
  add("A6", "A6");
  add("Letter", "Letter");
  add("Legal", "Legal").dictionary = "tag36h11";
  SheetOptions& legacy = add("Tabloid, legacy layout, 12 x 18", "Tabloid");
  legacy.squares = {12, 18};
  legacy.legacy_layout = true;
  add("300 x 200 mm, full board", "300x200").full_board = true;
  add("A4 checkerboard", "A4").kind = "checkerboard";
  return sheets;
}

}  // namespace glint::testing
