#include "fitting/photographs/photographs.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/parallel/parallel.h"
#include "base/resampling/resampling.h"

namespace glint {
namespace {

Photograph Downsample(const Photograph& from, const SamplePlane& big, int width, int height,
                      int threads) {
  const size_t texels = static_cast<size_t>(width) * height;
  const size_t big_texels = static_cast<size_t>(big.width) * big.height;
  Photograph to{from.view, from.ldr, std::vector<float>(3 * texels), std::vector<float>(texels)};
  const std::vector<Overlaps> across = AreaOverlaps(big.width, width);
  const std::vector<Overlaps> down = AreaOverlaps(big.height, height);
  ForEachBlock(height, 16, threads, [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      for (int column = 0; column < width; ++column) {
        double area = 0, usable = 0, sum[3] = {0, 0, 0};
        for (size_t u = 0; u < down[row].shares.size(); ++u) {
          for (size_t v = 0; v < across[column].shares.size(); ++v) {
            const size_t i = (down[row].first + u) * big.width + across[column].first + v;
            const double weight = down[row].shares[u] * across[column].shares[v];
            const double used = weight * from.mask[i];
            area += weight;
            if (used <= 0) continue;
            usable += used;
            for (int c = 0; c < 3; ++c) sum[c] += used * from.rgb[c * big_texels + i];
          }
        }
        const size_t o = static_cast<size_t>(row) * width + column;
        to.mask[o] = static_cast<float>(usable / area);
        for (int c = 0; c < 3; ++c) {
          to.rgb[c * texels + o] = usable > 0 ? static_cast<float>(sum[c] / usable) : 0.0f;
        }
      }
    }
  });
  return to;
}

std::string CheckPhotograph(const Photograph& p, size_t texels) {
  if (p.rgb.size() != 3 * texels || p.mask.size() != texels) return "is not of the set's size";
  bool usable = false;
  for (size_t i = 0; i < texels; ++i) {
    if (!(p.mask[i] >= 0.0f && p.mask[i] <= 1.0f)) return "has a mask value outside 0 to 1";
    if (p.mask[i] == 0.0f) continue;
    usable = true;
    for (int c = 0; c < 3; ++c) {
      if (!std::isfinite(p.rgb[c * texels + i])) return "has a usable value that is not finite";
    }
  }
  return usable ? "" : "has no usable texel: its mask is 0 everywhere";
}

}  // namespace

std::string PhotographSet::Check() const {
  if (plane.width < 1 || plane.height < 1) return "the sample has no texels";
  if (photographs.empty()) return "there is no photograph";
  const size_t texels = static_cast<size_t>(plane.width) * plane.height;
  std::string unusable;
  size_t bad = 0;
  for (size_t i = 0; i < photographs.size(); ++i) {
    const std::string wrong = CheckPhotograph(photographs[i], texels);
    if (wrong.empty()) continue;
    const std::string named = "photograph " + std::to_string(i) + " " + wrong;
    // A photograph that shows nothing is no harm as long as another does.
    if (wrong.rfind("has no usable", 0) != 0) return named;
    ++bad;
    unusable = named;
  }
  return bad == photographs.size() ? unusable : "";
}

PhotographSet Downsampled(const PhotographSet& set, int width, int height, int threads) {
  if (width < 1 || height < 1 || width > set.plane.width || height > set.plane.height) {
    throw std::invalid_argument("Downsampled: the size must be from 1 to the set's");
  }
  if (width == set.plane.width && height == set.plane.height) return set;
  PhotographSet small;
  small.plane = set.plane;
  small.plane.width = width;
  small.plane.height = height;
  small.convention = set.convention;
  small.light_power_known = set.light_power_known;
  small.room = set.room;
  for (const Photograph& p : set.photographs) {
    small.photographs.push_back(Downsample(p, set.plane, width, height, threads));
  }
  return small;
}

}  // namespace glint
