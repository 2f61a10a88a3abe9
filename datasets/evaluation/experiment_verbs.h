// The verbs of glint-eval that repeat the paper's experiments.
#pragma once

#include <vector>

#include "pipeline/contract/verbs.h"

namespace glint {

std::vector<Verb> ExperimentVerbs();

}  // namespace glint
