// Spots of constant radiance in photographs, as EstimateResponse wants them.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "calib/response/response.h"

namespace glint {

// The same spots for R, G and B.
using ResponseProblems = std::array<ResponseProblem, 3>;

// A series of one still scene at several exposures, camera fixed. The picture is cut into cells;
// a cell that is even (its values differ little) is a spot. `exposures`: given ones, or empty: by
// EXIF (time · ISO / f-number²). One photograph is in memory at a time. Throws UserError naming the
// photograph: of another size, without EXIF, linear by nature (RAW, EXR), all exposures equal.
ResponseProblems SampleSeries(const std::vector<std::filesystem::path>& photos,
                              const std::vector<double>& exposures);

// A patch of known reflectance: a rectangle of the upright picture, in pixels.
struct GreyPatch {
  double x = 0, y = 0, width = 0, height = 0;
  double reflectance = 0;
};

// {"patches": [{"x", "y", "width", "height", "reflectance"}, …]}. Throws UserError.
std::vector<GreyPatch> ReadPatches(const std::filesystem::path& file);

// Photographs of the same patches at the same places, evenly lit.
ResponseProblems SamplePatches(const std::vector<std::filesystem::path>& photos,
                               const std::vector<GreyPatch>& patches);

}  // namespace glint
