// What a ChArUco board's description has wrong when many markers are seen and it does not explain
// where they lie.
#pragma once

#include <string>
#include <vector>

#include "calib/corners/detector.h"
#include "calib/corners/markers.h"

namespace glint::corners {

// `agreeing`: of the markers `seen`, those that lie where the description has them. Tries one
// change at a time (layout, squares exchanged, markers' size, dictionary) and names the one that
// explains most of what is seen, with the field to correct; "": none does.
std::string ExplainMismatch(const GrayImage& image, const Board& board,
                            const DetectorOptions& options, const std::vector<SeenMarker>& seen,
                            size_t agreeing);

}  // namespace glint::corners
