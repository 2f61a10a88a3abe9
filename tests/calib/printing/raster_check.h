// Printed sheets, rasterised by poppler's pdftoppm, and where their corners then lie.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/corners/gray_image.h"
#include "calib/printing/sheet_plan.h"

namespace glint::testing {

struct RasterErrors {
  int corners = 0, found = 0;
  double rms_px = 0, worst_px = 0;
};

// The first page as a program of poppler-utils draws it: pdftocairo, whose pixels hold the share of
// ink to 1/255, or pdftoppm, which places every edge to a quarter of a pixel. Throws
// EnvironmentError without the program.
GrayImage Rasterize(const std::filesystem::path& pdf, int dpi,
                    const std::string& program = "pdftocairo");

// Every corner of the sheet's squares in the raster, against its place by the description.
RasterErrors CheckCorners(const BoardFile& file, const GrayImage& raster, int dpi);

// The ten boards of the table in docs/real-captures.md.
struct NamedSheet {
  std::string name;
  SheetOptions options;
};
std::vector<NamedSheet> TenSheets();

}  // namespace glint::testing
