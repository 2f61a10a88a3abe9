// glint-eval relight: maps against interpolation of the photographs.
#pragma once

#include "pipeline/contract/verbs.h"

namespace glint {

Verb RelightVerb();

}  // namespace glint
