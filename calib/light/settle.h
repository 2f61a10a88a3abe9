// What is decided before the light is solved for in full: pixels that were turned, photographs that
// contradict the others, the tone curve, a flash before or behind the lens.
//
// Decisions need few spots: neighbours share their errors, so every tenth tells as much.
#pragma once

#include "calib/light/light_state.h"

namespace glint::light {

// Decides for `state`, whose parameters are the start and stay it. False: no flash near the lens
// explains the paper.
bool Settle(const LightProblem& problem, const LightOptions& options, State* state, int* rounds);

}  // namespace glint::light
