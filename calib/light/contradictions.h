// What the paper's brightness says against EXIF, the encoding and the flash's place.
//
// Exposures, a tone curve and a flash before or behind the lens explain the same dark or bright
// paper, so each starts from what is known beforehand (light_state.h, Prior), and one of them gives
// way only where the paper insists on it.
#pragma once

#include "calib/light/light_state.h"

namespace glint::light {

// A photograph whose exposure contradicts EXIF by more than a fifth, while the others agree with
// theirs, leaves `start`: one at a time, the worst first. `solved` is the solution with it. True:
// one left.
bool LeaveOutContradiction(const LightOptions& options, const State& solved, State* start);

// Of those that left: their exposure by the paper; and where their own fall-off of the light tells
// that they were taken from farther off, and enlarged, by how much.
void ExplainContradictions(State* solved);

// Whether the paper insists on `solved` against `other`, a solution with fewer freedoms.
bool Insists(const LightOptions& options, const State& solved, const State& other);
// Whether it prefers `solved`, which has no more freedoms and is as likely beforehand.
bool Prefers(const LightOptions& options, const State& solved, const State& other);

// Frees, in `start`, the tone curve or the flash's place along the axis where the paper insists on
// either, and replaces `solved`. True: it did.
bool FreeWhatThePaperInsistsOn(const LightProblem& problem, const LightOptions& options,
                               State* start, State* solved);

}  // namespace glint::light
