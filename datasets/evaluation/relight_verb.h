// glint-eval relight: maps against interpolation of the photographs.
#pragma once

#include "base/programs/verbs.h"

namespace glint {

Verb RelightVerb();

}  // namespace glint
