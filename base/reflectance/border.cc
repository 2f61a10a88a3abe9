#include "base/reflectance/border.h"

#include <algorithm>

namespace glint {

int BorderInset(int width, int height, int rings) {
  return std::max(0, std::min({rings, (width - 1) / 2, (height - 1) / 2}));
}

void ContinueBorder(SvbrdfMaps* maps, int rings) {
  const int width = maps->width, height = maps->height;
  const int inset = BorderInset(width, height, rings);
  if (inset == 0) return;
  for (int plane = 0; plane < kSvbrdfPlanes; ++plane) {
    for (int row = 0; row < height; ++row) {
      const int from_row = std::clamp(row, inset, height - 1 - inset);
      for (int column = 0; column < width; ++column) {
        const int from_column = std::clamp(column, inset, width - 1 - inset);
        maps->at(plane, row, column) = maps->at(plane, from_row, from_column);
      }
    }
  }
}

}  // namespace glint
