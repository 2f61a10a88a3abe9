#include "fitting/tiling/period.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/resampling/resampling.h"

namespace glint {
namespace {

constexpr int kCoarseSize = 256;  // texels; periods are longer than what this loses
constexpr int kMostTexels = 512;  // of a line that are compared
constexpr int kSearchRadius = 2;  // coarse texels round the coarse answer

// Differences between lines (columns if `across`) of the maps, mean square over lines' texels.
class Lines {
 public:
  Lines(const EncodedMaps& maps, bool across) : maps_(maps), across_(across) {}
  int count() const { return across_ ? maps_.width : maps_.height; }

  double Difference(int a, int b) const {
    const int length = across_ ? maps_.height : maps_.width;
    const int stride = std::max(1, length / kMostTexels);
    const size_t step = across_ ? static_cast<size_t>(maps_.width) : 1;
    const size_t texels = static_cast<size_t>(maps_.width) * maps_.height;
    double sum = 0;
    for (int p = 0; p < kEncodedChannels; ++p) {
      const float* plane = maps_.planes.data() + p * texels;
      const float* first = plane + Offset(a);
      const float* second = plane + Offset(b);
      for (int i = 0; i < length; i += stride) {
        const double d = first[i * step] - second[i * step];
        sum += d * d;
      }
    }
    return sum * stride / length;
  }

 private:
  size_t Offset(int line) const {
    return static_cast<size_t>(line) * (across_ ? 1 : static_cast<size_t>(maps_.width));
  }
  const EncodedMaps& maps_;
  bool across_;
};

struct Candidate {
  Interval interval;
  double cost = std::numeric_limits<double>::infinity();
};

// Costs of begins in [first, last] for one length: mean differences over the overlap there, and
// over the whole sample, for every texel that the piece is long. (The overlap alone may lie within
// one tile of a floor and fit at any length.)
void AddCandidates(const Lines& lines, int length, int overlap, int first, int last,
                   std::vector<Candidate>* candidates) {
  const int shifted = lines.count() - length;
  std::vector<double> sums{0};  // running
  for (int x = 0; x < shifted; ++x) sums.push_back(sums.back() + lines.Difference(x, x + length));
  const double everywhere = sums.back() / shifted;
  for (int x = first; x <= last; ++x) {
    const auto i = static_cast<size_t>(x);
    const double here = (sums[i + static_cast<size_t>(overlap)] - sums[i]) / overlap;
    candidates->push_back({{x, length}, (here + everywhere) / length});
  }
}

Interval Best(const std::vector<Candidate>& candidates) {
  const auto by_cost = [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; };
  return std::min_element(candidates.begin(), candidates.end(), by_cost)->interval;
}

EncodedMaps Smaller(const EncodedMaps& maps, int width, int height) {
  EncodedMaps out(width, height);
  out.planes = ResamplePlanes(maps.planes, maps.width, maps.height, AreaTaps(maps.width, width),
                              AreaTaps(maps.height, height));
  return out;
}

}  // namespace

Interval BestInterval(const EncodedMaps& maps, bool across, int least, int overlap) {
  const int full = across ? maps.width : maps.height;
  const int coarse = std::min(full, kCoarseSize);
  const double scale = static_cast<double>(full) / coarse;
  const EncodedMaps small = Smaller(maps, across ? coarse : std::min(maps.width, kCoarseSize),
                                    across ? std::min(maps.height, kCoarseSize) : coarse);
  const Lines coarse_lines(small, across);
  const int coarse_overlap = std::max(1, static_cast<int>(overlap / scale));
  std::vector<Candidate> candidates;
  for (int length = std::max(1, static_cast<int>(std::ceil(least / scale)));
       length + coarse_overlap <= coarse; ++length) {
    AddCandidates(coarse_lines, length, coarse_overlap, 0, coarse - length - coarse_overlap,
                  &candidates);
  }
  const Interval found =
      candidates.empty() ? Interval{0, coarse - coarse_overlap} : Best(candidates);
  if (coarse == full) return found;

  const Lines lines(maps, across);
  const int radius = static_cast<int>(std::ceil(kSearchRadius * scale));
  const int length = static_cast<int>(std::lround(found.length * scale));
  const int begin = static_cast<int>(std::lround(found.begin * scale));
  candidates.clear();
  for (int l = std::max(least, length - radius); l <= std::min(full - overlap, length + radius);
       ++l) {
    const int most = full - l - overlap;
    const int first = std::clamp(begin - radius, 0, most);
    AddCandidates(lines, l, overlap, first, std::clamp(begin + radius, first, most), &candidates);
  }
  return Best(candidates);
}

}  // namespace glint
