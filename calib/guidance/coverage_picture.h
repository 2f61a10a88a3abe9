// Where highlights fall on the sample, as a picture.
#pragma once

#include "base/images/image.h"
#include "calib/guidance/verdict.h"

namespace glint {

// The sample as its maps show it, a square a cell, coloured by the least angle between normal and
// half vector: yellow where a highlight is seen, through green to dark blue at 30° and more; grey
// where no photograph shows the cell. A scale stands below.
Image CoveragePicture(const Verdict& verdict);

}  // namespace glint
