#include "fitting/latent/levels.h"

#include <algorithm>
#include <span>

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
  return ResizedRows(maps, width, height, 0, height);
}

EncodedMaps ResizedRows(const EncodedMaps& maps, int width, int height, int first_row, int rows) {
  if (maps.width == width && maps.height == height && rows == height) return maps;
  EncodedMaps out(width, rows);
  const std::vector<Taps> down = TentTaps(maps.height, height);
  const TapGroup group =
      GroupTaps(std::span(down).subspan(static_cast<size_t>(first_row), static_cast<size_t>(rows)),
                maps.height)
          .front();
  const size_t row = static_cast<size_t>(maps.width),
               texels = row * static_cast<size_t>(maps.height);
  std::vector<float> from;
  for (size_t plane = 0; plane < maps.planes.size(); plane += texels) {
    const float* begin = maps.planes.data() + plane + static_cast<size_t>(group.first_input) * row;
    from.insert(from.end(), begin, begin + static_cast<size_t>(group.inputs) * row);
  }
  out.planes =
      ResamplePlanes(from, maps.width, group.inputs, TentTaps(maps.width, width), group.taps);
  return out;
}

}  // namespace glint
