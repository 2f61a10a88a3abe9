// The verbs of glint-eval that repeat the paper's experiments.
#pragma once

#include <vector>

#include "base/programs/verbs.h"

namespace glint {

std::vector<Verb> ExperimentVerbs();

}  // namespace glint
