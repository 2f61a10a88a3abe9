// Printed sheets, rasterised by poppler's pdftoppm, and where their corners then lie.
#pragma once

#include <filesystem>
#include <string>

#include "calib/corners/gray_image.h"
#include "calib/printing/sheet_plan.h"

namespace glint::testing {

struct RasterErrors {
  int corners = 0, found = 0;
  double rms_px = 0, worst_px = 0;
};

// The first page as poppler draws it at `dpi`. It places edges to a quarter of its pixels, so it
// draws `oversampling` times finer and its pixels are averaged. Throws EnvironmentError without
// pdftoppm.
GrayImage Rasterize(const std::filesystem::path& pdf, int dpi, int oversampling);

// Every corner of the sheet's squares in the raster, against its place by the description.
RasterErrors CheckCorners(const BoardFile& file, const GrayImage& raster, int dpi);

// The ten boards of the table in docs/real-captures.md.
struct NamedSheet {
  std::string name;
  SheetOptions options;
};
std::vector<NamedSheet> TenSheets();

}  // namespace glint::testing
