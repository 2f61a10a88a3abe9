// The verb of glint-eval that compares tiles with the samples they were cut from.
#pragma once

#include "pipeline/contract/verbs.h"

namespace glint {

Verb TilingVerb();

}  // namespace glint
