// What time and use add to any material: tone, grain, dirt, gloss wear, scratches, waviness.
#pragma once

#include "datasets/procedural/layers.h"
#include "datasets/procedural/random.h"

namespace glint::procedural {

// A function that modifies rows that a family has filled. Many draws change little or nothing.
RowFunction DrawWeathering(Rng& rng);

}  // namespace glint::procedural
