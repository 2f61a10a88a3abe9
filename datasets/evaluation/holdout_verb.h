// glint-eval holdout.
#pragma once

#include "base/programs/verbs.h"

namespace glint {

Verb HoldoutVerb();

}  // namespace glint
