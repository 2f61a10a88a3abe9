#include "fitting/refine/sample_source.h"

#include <algorithm>
#include <utility>

#include "base/resampling/resampling.h"
#include "fitting/photographs/cast_shadows.h"
#include "fitting/refine/correct_views.h"

namespace glint {
namespace {

// Of which texels are picked at a time.
constexpr int kRowsAtOnce = 256;

RectifiedSet WithModelOf(RectifiedSet set, const std::filesystem::path& maps_file) {
  ReflectanceConvention of_maps;
  const SvbrdfReader reader(maps_file, &of_maps);
  set.convention.diffuse_weight = of_maps.diffuse_weight;
  set.convention.lobes = of_maps.lobes;
  return set;
}

}  // namespace

SampleSource::SampleSource(const RectifiedSet& set, const std::vector<RectifiedView>& views,
                           const Vec3d& light_scale_rgb, std::filesystem::path maps_file,
                           const std::filesystem::path& deviations_file)
    : maps_file_(std::move(maps_file)),
      maps_(maps_file_, set.plane.width, set.plane.height),
      photographs_(WithModelOf(set, maps_file_), views, light_scale_rgb) {
  if (!deviations_file.empty()) {
    deviations_.emplace(deviations_file, set.plane.width, set.plane.height);
  }
}

RefineProblem SampleSource::Part::Problem() const {
  RefineProblem problem = ProblemOf(photographs);
  problem.initial_sd = start_sd.planes;
  return problem;
}

void SampleSource::Correct(ViewCorrections corrections) { corrections_ = std::move(corrections); }

void SampleSource::MaskShadows(int threads) {
  constexpr int kSide = 256;  // of the texels that tell the relief's slopes
  const int stride = std::max(1, std::max(plane().width, plane().height) / kSide);
  relief_slope_sd_ = ReliefSlopeSd(Every(stride, threads).photographs, threads);
}

PhotographSet SampleSource::PhotographRows(int first_row, int rows, int threads) {
  PhotographSet set = CorrectedRows(first_row, rows, threads);
  MaskCastShadows(relief_slope_sd_, threads, &set);
  return set;
}

PhotographSet SampleSource::CorrectedRows(int first_row, int rows, int threads) {
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
  return {PhotographRows(first_row, rows, threads), maps_.Read(first_row, rows),
          deviations_ ? deviations_->Read(first_row, rows) : SvbrdfDeviations()};
}

SampleSource::Part SampleSource::Every(int stride, int threads) {
  if (stride == 1) return Rows(0, plane().height, threads);
  const SamplePlane picked = plane().Every(stride);
  Part part{Views(), SvbrdfMaps(picked.width, picked.height), {}};
  if (deviations_) part.start_sd = SvbrdfDeviations(picked.width, picked.height);
  part.photographs.plane = picked;
  for (Photograph& p : part.photographs.photographs) {
    p.rgb.assign(3 * part.start.texels(), 0.0f);
    p.mask.assign(part.start.texels(), 0.0f);
  }
  const int at_once = std::max(1, kRowsAtOnce / stride) * stride;
  for (int first = 0; first < plane().height; first += at_once) {
    const int rows = std::min(at_once, plane().height - first);
    Part from = Rows(first, rows, threads);
    const auto take = [&](const std::vector<float>& planes, std::vector<float>* to) {
      PutRows(PickEvery(planes, plane().width, rows, stride), picked.width, picked.height,
              first / stride, *to);
    };
    take(from.start.planes, &part.start.planes);
    if (deviations_) take(from.start_sd.planes, &part.start_sd.planes);
    part.photographs.environment = from.photographs.environment;
    part.photographs.systematic_sd = from.photographs.systematic_sd;
    for (size_t v = 0; v < from.photographs.photographs.size(); ++v) {
      Photograph &some = from.photographs.photographs[v], &to = part.photographs.photographs[v];
      to.view = some.view;
      take(some.rgb, &to.rgb);
      take(some.mask, &to.mask);
    }
  }
  return part;
}

SampleSource::Part SampleSource::Downsampled(int width, int height, int threads) {
  return {photographs_.Downsampled(width, height, threads),
          ResampledSvbrdf(maps_file_, width, height).Read(0, height),
          {}};
}

}  // namespace glint
