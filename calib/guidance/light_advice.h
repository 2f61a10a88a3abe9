// What to say of a camera that stood still while the light was moved. Topics beside advice.h's:
//   few_lights   more lights tell gloss and relief apart
//   light_sides  no light from one side
//   high_lights  no light from high above
//   low_lights   no raking light
#pragma once

#include <string>
#include <vector>

#include "calib/guidance/verdict.h"

namespace glint {

// Fills the figures of the lights.
void DescribeLights(const GuidanceInput& input, Verdict* verdict);

// One line of figures.
std::string LightSummary(const Verdict& verdict);

// As AdviceFor(): sorted by importance.
std::vector<Advice> LightAdviceFor(const GuidanceInput& input, const Verdict& verdict);

}  // namespace glint
