// What a person gave a stage on its command line holds in later runs too, until the stage is run
// without it or capture.toml names the option.
#pragma once

#include <string>
#include <vector>

#include "base/formats/capture.h"
#include "pipeline/driver/stage_graph.h"

namespace glint {

// Fills `kept` of each step from the stage's last result. Returns a sentence for each option that
// is kept, and for each that capture.toml overrides with another value.
std::vector<std::string> KeepOptions(const Capture& capture, std::vector<StageStep>* steps);

}  // namespace glint
