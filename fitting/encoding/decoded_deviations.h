// Standard deviations of maps from what is expected of their encoded values.
#pragma once

#include "base/reflectance/svbrdf_deviations.h"
#include "fitting/encoding/encoding.h"

namespace glint {

// `error`: mean absolute error b expected of each encoded value, whose distribution is Laplace's
// about `maps`, as the estimator's loss has it; its standard deviation is √2·b. Carried through the
// decoding to second order where that is a square: a dark albedo's deviation does not vanish with
// its slope.
SvbrdfDeviations DecodedDeviations(const EncodedMaps& maps, const EncodedMaps& error);

}  // namespace glint
