// Fewer spots for the same light: a printed board shows thousands in a photograph, and neighbours
// share their errors (blur of the ink, JPEG, a crease), so that some of each block tell as much.
#pragma once

#include <cstddef>

#include "calib/light/light_state.h"

namespace glint::light {

// Every so-manieth spot of each photo, at most about `spots`, weighed so that a block tells as much
// as before.
State Thinned(const State& full, size_t spots);

// Parameters and decisions of `thin` for `full`, which keeps its spots, turned as decided.
void Adopt(const State& thin, State* full);

}  // namespace glint::light
