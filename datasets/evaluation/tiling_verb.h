// The verb of glint-eval that compares tiles with the samples they were cut from.
#pragma once

#include "base/programs/verbs.h"

namespace glint {

Verb TilingVerb();

}  // namespace glint
