// Which part of a sample to repeat.
#pragma once

#include "fitting/encoding/encoding.h"

namespace glint {

struct Interval {
  int begin = 0, length = 0;
};

// Along the width (`across`) or the height: the interval of at least `least` texels with the least
// cost for every texel of its length: in a surface covered with pieces, joints are the rarer the
// longer a piece is. The cost is the mean square difference between the interval's beginning and
// what follows its end, over `overlap` texels, and that of the whole sample from itself, moved by
// the length. So a texture with a period gives a multiple of it, one without a long piece. Begin +
// length + overlap is at most the maps' size. Looked for on a grid of at most 256 texels a side,
// then texel by texel round the best.
Interval BestInterval(const EncodedMaps& maps, bool across, int least, int overlap);

}  // namespace glint
