// The drawing of a planned sheet.
#pragma once

#include "base/formats/board_file.h"
#include "calib/printing/drawing.h"

namespace glint {

// `file` must have a sheet and be at its designed size (print_scale 1). `paper_reflectance` tells
// which level of grey each patch is printed with.
Drawing DrawSheet(const BoardFile& file, double paper_reflectance);

}  // namespace glint
