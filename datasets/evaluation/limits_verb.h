// The verb of glint-eval that measures what auto-encoders can express at all.
#pragma once

#include "base/programs/verbs.h"

namespace glint {

Verb LimitsVerb();

}  // namespace glint
