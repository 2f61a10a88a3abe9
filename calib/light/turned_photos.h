// Which photographs' pixels were turned without EXIF's knowledge, from where their flash seems to
// be.
//
// Gallery apps and exports turn the pixels of an upright photograph and set the orientation tag to
// 1. Lens, fall-off and flash turn with the camera, not with the picture: a flash 10 mm to the
// right of the lens is 10 mm below it in a picture that was turned by 90°. So each photograph gets
// a flash of its own first; then one flash and one turn of each photograph are looked for that
// explain them.
#pragma once

#include "calib/light/light_state.h"

namespace glint::light {

// Sets `turns` of every used photo of `state`, and its spots' geometry and exposures' start with
// it. A turn that EXIF does not tell of (not the first of LightPhoto::possible_turns) needs 50
// times the evidence, unless the picture's size contradicts EXIF already; without `unexpected`
// there are none. True: there are.
bool FindTurns(const LightProblem& problem, const LightOptions& options, bool unexpected,
               State* state);

// Brings a photo's spots from its picture's frame to that of a sensor that was turned so often.
void TurnSpots(int turns, PhotoState* photo);

}  // namespace glint::light
