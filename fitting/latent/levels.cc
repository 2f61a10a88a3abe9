#include "fitting/latent/levels.h"

#include <algorithm>

#include "base/resampling/resampling.h"

namespace glint {
std::vector<std::pair<int, int>> LevelSizes(int width, int height, int coarse_size,
                                            int finest_size) {
  std::vector<std::pair<int, int>> sizes{{width, height}};
  while (std::max(sizes.back().first, sizes.back().second) > coarse_size) {
    sizes.emplace_back((sizes.back().first + 1) / 2, (sizes.back().second + 1) / 2);
  }
  while (sizes.size() > 1 && std::max(sizes.front().first, sizes.front().second) > finest_size) {
    sizes.erase(sizes.begin());
  }
  std::reverse(sizes.begin(), sizes.end());
  return sizes;
}

EncodedMaps Resized(const EncodedMaps& maps, int width, int height) {
  if (maps.width == width && maps.height == height) return maps;
  EncodedMaps out(width, height);
  out.planes = ResamplePlanes(maps.planes, maps.width, maps.height, TentTaps(maps.width, width),
                              TentTaps(maps.height, height));
  return out;
}

}  // namespace glint
