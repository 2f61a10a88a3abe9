// The verb of glint-eval that measures the light calibration.
#pragma once

#include "base/programs/verbs.h"

namespace glint {

Verb LightVerb();

}  // namespace glint
