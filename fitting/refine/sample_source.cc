#include "fitting/refine/sample_source.h"

#include <algorithm>
#include <utility>

#include "base/resampling/resampling.h"

namespace glint {
namespace {

// Of which texels are picked at a time.
constexpr int kRowsAtOnce = 256;

RectifiedSet WithWeightOf(RectifiedSet set, const std::filesystem::path& maps_file) {
  ReflectanceConvention of_maps;
  SvbrdfReader(maps_file, &of_maps);
  set.convention.diffuse_weight = of_maps.diffuse_weight;
  return set;
}

// Planes of width × height picked of planes that are `from_width` wide: every stride-th column of
// every stride-th row, from the middle of a stride on.
struct Picking {
  size_t from_width, from_texels, width, texels;
  int stride;

  void Rows(const float* from, int rows, size_t planes, size_t first_row, float* to) const {
    const auto middle = static_cast<size_t>(stride / 2), step = static_cast<size_t>(stride);
    for (size_t p = 0; p < planes; ++p) {
      size_t row = first_row;
      for (size_t r = middle; r < static_cast<size_t>(rows); r += step, ++row) {
        for (size_t column = 0; column < width; ++column) {
          to[p * texels + row * width + column] =
              from[p * from_texels + r * from_width + middle + column * step];
        }
      }
    }
  }
};

}  // namespace

SampleSource::SampleSource(const RectifiedSet& set, const std::vector<RectifiedView>& views,
                           const Vec3d& light_scale_rgb, std::filesystem::path maps_file)
    : maps_file_(std::move(maps_file)),
      maps_(maps_file_, set.plane.width, set.plane.height),
      photographs_(WithWeightOf(set, maps_file_), views, light_scale_rgb) {}

void SampleSource::Correct(ViewCorrections corrections) { corrections_ = std::move(corrections); }

PhotographSet SampleSource::PhotographRows(int first_row, int rows, int threads) {
  if (corrections_.views.empty()) return photographs_.Rows(first_row, rows, threads);
  const int reached = RowsReached(corrections_);
  const int above = std::min(first_row, reached);
  const int below = std::min(plane().height - first_row - rows, reached);
  PhotographSet set = Corrected(photographs_.Rows(first_row - above, above + rows + below, threads),
                                corrections_, threads);
  if (above + below == 0) return set;
  for (Photograph& p : set.photographs) {
    p.rgb = CutRows(p.rgb, set.plane.width, set.plane.height, above, rows);
    p.mask = CutRows(p.mask, set.plane.width, set.plane.height, above, rows);
  }
  set.plane = plane().Rows(first_row, rows);
  return set;
}

SampleSource::Part SampleSource::Rows(int first_row, int rows, int threads) {
  return {PhotographRows(first_row, rows, threads), maps_.Read(first_row, rows)};
}

SampleSource::Part SampleSource::Every(int stride, int threads) {
  if (stride == 1) return Rows(0, plane().height, threads);
  Part part;
  const SamplePlane picked = plane().Every(stride);
  const auto width = static_cast<size_t>(picked.width);
  const size_t texels = width * static_cast<size_t>(picked.height);
  part.start = SvbrdfMaps(picked.width, picked.height);
  const int at_once = std::max(1, kRowsAtOnce / stride) * stride;
  for (int first = 0; first < plane().height; first += at_once) {
    const int rows = std::min(at_once, plane().height - first);
    const Part from = Rows(first, rows, threads);
    const Picking picking{static_cast<size_t>(plane().width), from.start.texels(), width, texels,
                          stride};
    const auto row = static_cast<size_t>(first / stride);
    if (first == 0) {
      part.photographs = from.photographs;
      part.photographs.plane = picked;
      for (Photograph& p : part.photographs.photographs) {
        p.rgb.assign(3 * texels, 0.0f);
        p.mask.assign(texels, 0.0f);
      }
    }
    picking.Rows(from.start.planes.data(), rows, kSvbrdfPlanes, row, part.start.planes.data());
    for (size_t v = 0; v < from.photographs.photographs.size(); ++v) {
      const Photograph& p = from.photographs.photographs[v];
      Photograph& to = part.photographs.photographs[v];
      picking.Rows(p.rgb.data(), rows, 3, row, to.rgb.data());
      picking.Rows(p.mask.data(), rows, 1, row, to.mask.data());
    }
  }
  return part;
}

SampleSource::Part SampleSource::Downsampled(int width, int height, int threads) {
  return {photographs_.Downsampled(width, height, threads),
          ResampledSvbrdf(maps_file_, width, height).Read(0, height)};
}

}  // namespace glint
