// Ten printed boards at 150, 300 and 600 dpi: where the corners of poppler's rasters lie:
// bench_printing [pdftocairo|pdftoppm]. Exit 1: one is off by more than 0.05 px.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "base/files/files.h"
#include "calib/printing/draw_sheet.h"
#include "tests/calib/printing/raster_check.h"

int main(int argc, char** argv) {
  using namespace glint;
  namespace fs = std::filesystem;
  const std::string program = argc > 1 ? argv[1] : "pdftocairo";  // or pdftoppm
  const fs::path folder =
      fs::temp_directory_path() / ("glint_printing_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  double worst_px = 0;
  fmt::print("| board | squares | corners | 150 dpi RMS / worst, px | 300 dpi | 600 dpi |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  for (const auto& [name, options] : testing::TenSheets()) {
    const BoardFile file = PlanSheet(options);
    WriteFileAtomically(folder / "board.pdf", PdfOf(DrawSheet(file, options.paper_reflectance)));
    fmt::print("| {} | {} x {} of {:.6g} mm |", name, file.board.squares_x, file.board.squares_y,
               file.board.square_mm);
    int found = 0, corners = 0;
    std::string cells;
    for (const int dpi : {150, 300, 600}) {
      const auto raster = testing::Rasterize(folder / "board.pdf", dpi, program);
      const auto errors = testing::CheckCorners(file, raster, dpi);
      found += errors.found;
      corners += errors.corners;
      worst_px = std::max(worst_px, errors.worst_px);
      cells += fmt::format(" {:.4f} / {:.4f} |", errors.rms_px, errors.worst_px);
    }
    fmt::print(" {} of {} |{}\n", found / 3, corners / 3, cells);
    std::fflush(stdout);
  }
  fs::remove_all(folder);
  fmt::print("worst of all: {:.4f} px\n", worst_px);
  return worst_px <= 0.05 ? 0 : 1;
}
