#include "fitting/latent/levels.h"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

// Triangle filter as wide as the coarser of the two grids' texels: bilinear up, tent-averaged down.
struct Tap {
  int first;
  std::vector<float> weights;
};

std::vector<Tap> Taps(int input, int output) {
  std::vector<Tap> taps(output);
  const double scale = static_cast<double>(input) / output, radius = std::max(1.0, scale);
  for (int i = 0; i < output; ++i) {
    const double centre = (i + 0.5) * scale;
    const int begin = std::max(0, static_cast<int>(std::floor(centre - radius)));
    const int end = std::min(input, static_cast<int>(std::ceil(centre + radius)));
    double sum = 0;
    taps[i].first = begin;
    for (int k = begin; k < end; ++k) {
      const double w = std::max(0.0, 1.0 - std::abs(k + 0.5 - centre) / radius);
      taps[i].weights.push_back(static_cast<float>(w));
      sum += w;
    }
    for (float& w : taps[i].weights) w = static_cast<float>(w / sum);
  }
  return taps;
}

}  // namespace

std::vector<std::pair<int, int>> LevelSizes(int width, int height, int coarse_size) {
  std::vector<std::pair<int, int>> sizes{{width, height}};
  while (std::max(sizes.back().first, sizes.back().second) > coarse_size) {
    sizes.emplace_back((sizes.back().first + 1) / 2, (sizes.back().second + 1) / 2);
  }
  std::reverse(sizes.begin(), sizes.end());
  return sizes;
}

EncodedMaps Resized(const EncodedMaps& maps, int width, int height) {
  if (maps.width == width && maps.height == height) return maps;
  const std::vector<Tap> across = Taps(maps.width, width), down = Taps(maps.height, height);
  EncodedMaps out(width, height);
  std::vector<float> rows(static_cast<size_t>(maps.height) * width);
  for (int p = 0; p < kEncodedChannels; ++p) {
    const float* from = maps.planes.data() + p * maps.texels();
    for (int row = 0; row < maps.height; ++row) {
      for (int column = 0; column < width; ++column) {
        float sum = 0;
        for (size_t k = 0; k < across[column].weights.size(); ++k) {
          sum += across[column].weights[k] * from[row * maps.width + across[column].first + k];
        }
        rows[static_cast<size_t>(row) * width + column] = sum;
      }
    }
    float* to = out.planes.data() + p * out.texels();
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        float sum = 0;
        for (size_t k = 0; k < down[row].weights.size(); ++k) {
          sum += down[row].weights[k] * rows[(down[row].first + k) * width + column];
        }
        *to++ = sum;
      }
    }
  }
  return out;
}

}  // namespace glint
