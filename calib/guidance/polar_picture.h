// The directions that a sample was seen and lit from, as a picture.
#pragma once

#include <string>

#include "calib/guidance/verdict.h"

namespace glint {

// SVG: the sample's normal in the middle, rings every 10° of tilt, right to the right and the top
// of the maps on top. Numbered discs are cameras in the verdict's order, small stars their flashes,
// dashed circles the photographs that are suggested. Nothing is loaded and nothing runs.
std::string PolarPictureSvg(const Verdict& verdict);

}  // namespace glint
