// glint-eval holdout.
#pragma once

#include "pipeline/contract/verbs.h"

namespace glint {

Verb HoldoutVerb();

}  // namespace glint
