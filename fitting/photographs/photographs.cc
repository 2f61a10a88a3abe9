#include "fitting/photographs/photographs.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/parallel/parallel.h"
#include "base/resampling/resampling.h"

namespace glint {
namespace {

// Of LDR radiance; resampling may have mixed a little of a darker pixel in.
constexpr float kLimit = 0.99f;
// Radiance from which a masked texel of an LDR photograph is masked because a pixel is clipped.
constexpr float kMaskedBright = 0.25f;

float Brightest(const Photograph& photograph, size_t texel) {
  const size_t texels = photograph.mask.size();
  const std::vector<float>& rgb = photograph.rgb;
  return std::max({rgb[texel], rgb[texels + texel], rgb[2 * texels + texel]});
}

// Which samples of a picture make those of the smaller one.
struct Averaging {
  const SamplePlane& big;
  std::vector<Overlaps> across, down;
};

// Output rows begin … end, all of whose input rows are among `from`'s.
void AverageRows(const Averaging& averaging, const Photograph& from, int first_row, int begin,
                 int end, int threads, Photograph* to) {
  const size_t width = averaging.across.size(), texels = width * averaging.down.size();
  const size_t big_texels = from.mask.size();
  const auto big_width = static_cast<size_t>(averaging.big.width);
  ForEachBlock(end - begin, 16, threads, [&](int block_begin, int block_end) {
    for (int row = begin + block_begin; row < begin + block_end; ++row) {
      const Overlaps& down = averaging.down[static_cast<size_t>(row)];
      const size_t top = static_cast<size_t>(down.first - first_row);
      for (size_t column = 0; column < width; ++column) {
        const Overlaps& across = averaging.across[column];
        double area = 0, usable = 0, seen = 0, sum[3] = {0, 0, 0};
        bool clipped = false;
        for (size_t u = 0; u < down.shares.size(); ++u) {
          for (size_t v = 0; v < across.shares.size(); ++v) {
            const size_t i = (top + u) * big_width + static_cast<size_t>(across.first) + v;
            const double weight = down.shares[u] * across.shares[v];
            const bool limited = ReachesLimit(from, i);
            const double used = limited ? weight : weight * from.mask[i];
            area += weight;
            if (used <= 0) continue;
            clipped |= limited;
            usable += weight * from.mask[i];
            seen += used;
            for (size_t c = 0; c < 3; ++c) sum[c] += used * from.rgb[c * big_texels + i];
          }
        }
        const size_t o = static_cast<size_t>(row) * width + column;
        for (size_t c = 0; c < 3; ++c) {
          to->rgb[c * texels + o] = seen > 0 ? static_cast<float>(sum[c] / seen) : 0.0f;
        }
        to->mask[o] = !clipped                      ? static_cast<float>(usable / area)
                      : Brightest(*to, o) >= kLimit ? 1.0f
                                                    : 0.0f;
      }
    }
  });
}

// Of a picture read at once; more where one output row takes more.
constexpr int kRowsAtOnce = 256;

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

bool ReachesLimit(const Photograph& photograph, size_t texel) {
  if (!photograph.ldr) return false;
  return Brightest(photograph, texel) >= (photograph.mask[texel] < 0.5f ? kMaskedBright : kLimit);
}

std::string PhotographSet::Check() const {
  if (plane.width < 1 || plane.height < 1) return "the sample has no texels";
  if (photographs.empty()) return "there is no photograph";
  const size_t texels = static_cast<size_t>(plane.width) * plane.height;
  std::string unusable;
  size_t bad = 0;
  for (size_t i = 0; i < photographs.size(); ++i) {
    const std::string wrong = CheckPhotograph(photographs[i], texels);
    if (wrong.empty()) continue;
    std::string named = "photograph " + std::to_string(i) + " " + wrong;
    // A photograph that shows nothing is no harm as long as another does.
    if (wrong.rfind("has no usable", 0) != 0) return named;
    ++bad;
    unusable = std::move(named);
  }
  return bad == photographs.size() ? unusable : "";
}

Photograph DownsampledByRows(const ReadRows& read, const SamplePlane& plane, int width, int height,
                             int threads) {
  if (width < 1 || height < 1 || width > plane.width || height > plane.height) {
    throw std::invalid_argument("Downsampled: the size must be from 1 to the set's");
  }
  const Averaging averaging{plane, AreaOverlaps(plane.width, width),
                            AreaOverlaps(plane.height, height)};
  const size_t texels = static_cast<size_t>(width) * static_cast<size_t>(height);
  Photograph to{{}, true, std::vector<float>(3 * texels), std::vector<float>(texels)};
  const auto end_of = [&](int row) {
    const Overlaps& down = averaging.down[static_cast<size_t>(row)];
    return down.first + static_cast<int>(down.shares.size());
  };
  for (int begin = 0; begin < height;) {
    const int first_row = averaging.down[static_cast<size_t>(begin)].first;
    int end = begin + 1;
    while (end < height && end_of(end) - first_row <= kRowsAtOnce) ++end;
    const Photograph from = read(first_row, end_of(end - 1) - first_row);
    to.view = from.view;
    to.ldr = from.ldr;
    AverageRows(averaging, from, first_row, begin, end, threads, &to);
    begin = end;
  }
  return to;
}

PhotographSet Downsampled(const PhotographSet& set, int width, int height, int threads) {
  if (width == set.plane.width && height == set.plane.height) return set;
  PhotographSet small;
  small.plane = set.plane;
  small.plane.width = width;
  small.plane.height = height;
  small.convention = set.convention;
  small.light_power_known = set.light_power_known;
  small.environment = set.environment;
  small.systematic_sd = set.systematic_sd;
  for (const Photograph& p : set.photographs) {
    const ReadRows rows = [&](int first_row, int count) {
      const auto cut = [&](const std::vector<float>& planes) {
        return CutRows(planes, set.plane.width, set.plane.height, first_row, count);
      };
      return Photograph{p.view, p.ldr, cut(p.rgb), cut(p.mask)};
    };
    small.photographs.push_back(DownsampledByRows(rows, set.plane, width, height, threads));
  }
  return small;
}

}  // namespace glint
