// How far the lights that a fit used are from those that the photographs were taken with.
#pragma once

#include <filesystem>

#include "datasets/synth/view_set.h"

namespace glint {

// Angles at the sample's centre over the views of a set.
struct LightAngles {
  double mean_deg = 0, worst_deg = 0;
};

// Lights of `planned` as its manifest has them, moved by what the fit's manifest says in
// data.corrections (glint-refine writes it when it corrects views), against those that really
// shone. Throws UserError.
LightAngles CompareLights(const PlannedViews& planned, const std::filesystem::path& fit_manifest);

}  // namespace glint
