// How sharp each photograph is: the spread of its points, and what it weighs beside sharper ones.
//
// A photograph that is blurred more than the others differs from the right maps' rendering wherever
// there is detail. Its residuals have the variance σ² + e²: σ² that of all photographs, and e² what
// its blur hides (shared_detail.h). Its squared residuals therefore weigh σ²/(σ² + e²) of theirs.
#pragma once

#include "fitting/refine/point_spread.h"
#include "fitting/refine/refine.h"

namespace glint {

// Of the view's points: as it is said to be; as calibration measured its blur, with what resampling
// adds; or as expected.
PointSpread SpreadOf(const RefineView& view, const RefineOptions& options);

// Sets the views' weights where residuals have the variance σ².
void WeighViews(double variance, RefineProblem* problem);

}  // namespace glint
