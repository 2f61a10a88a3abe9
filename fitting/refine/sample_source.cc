#include "fitting/refine/sample_source.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel/parallel.h"
#include "base/resampling/resampling.h"
#include "fitting/refine/correct_views.h"

namespace glint {
namespace {

// Of which texels are picked at a time.
constexpr int kRowsAtOnce = 256;
// By which photographs' sharpness is compared.
constexpr int kRowsCompared = 512;

RectifiedSet WithModelOf(RectifiedSet set, const std::filesystem::path& maps_file) {
  ReflectanceConvention of_maps;
  const SvbrdfReader reader(maps_file, &of_maps);
  set.convention.diffuse_weight = of_maps.diffuse_weight;
  set.convention.lobes = of_maps.lobes;
  return set;
}

// To rows from the `above`-th on, which lie on `plane`.
void Cut(int above, int rows, const SamplePlane& plane, PhotographSet* set) {
  if (rows == set->plane.height) return;
  for (Photograph& p : set->photographs) {
    p.rgb = CutRows(p.rgb, set->plane.width, set->plane.height, above, rows);
    p.mask = CutRows(p.mask, set->plane.width, set->plane.height, above, rows);
  }
  set->plane = plane;
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

void SampleSource::CompareSharpness(const RefineOptions& options, int threads) {
  if (!options.share_detail || !SharedDetail::MayLack(Views(), options)) return;
  const int rows = std::min(kRowsCompared, plane().height);
  shared_detail_ =
      SharedDetail(CorrectedRows((plane().height - rows) / 2, rows, threads), options, threads);
}

PhotographSet SampleSource::Views() const {
  PhotographSet set = photographs_.WithoutPixels();
  shared_detail_.Describe(&set);
  return set;
}

// Larger maps have heights for blocks of texels: initial maps are no finer (fit's --finest-size).
HidingRelief SampleSource::ReliefOfMaps(int threads) {
  constexpr int kMostSide = 512, kSlopesSide = 256;
  const int longest = std::max(plane().width, plane().height);
  const int stride = (longest + kMostSide - 1) / kMostSide;
  SamplePlane coarse = plane();
  coarse.width = std::max(1, coarse.width / stride);
  coarse.height = std::max(1, coarse.height / stride);
  const SvbrdfMaps maps =
      ResampledSvbrdf(maps_file_, coarse.width, coarse.height).Read(0, coarse.height);
  HidingRelief relief{Horizon(IntegrateNormals(maps, coarse, 0, {}, threads), coarse), 0};
  const double slope_sd =
      ReliefSlopeSd(Every(std::max(1, longest / kSlopesSide), threads).photographs, threads);
  relief.finer_slope_sd =
      std::sqrt(std::max(0.0, slope_sd * slope_sd - relief.horizon.slope_variance()));
  return relief;
}

void SampleSource::MaskShadows(int threads) {
  if (Views().photographs.size() < kFewestForShadows) return;
  const HidingRelief relief = ReliefOfMaps(threads);
  const size_t width = static_cast<size_t>(plane().width);
  std::vector<std::vector<bool>> shadows(
      Views().photographs.size(),
      std::vector<bool>(width * static_cast<size_t>(plane().height), false));
  for (int first = 0; first < plane().height; first += kRowsAtOnce) {
    PhotographSet set =
        CorrectedRows(first, std::min(kRowsAtOnce, plane().height - first), threads);
    MaskCastShadows(relief, threads, &set);
    ForEachPiece(static_cast<int>(shadows.size()), threads, [&](int piece) {
      const auto view = static_cast<size_t>(piece);
      const std::vector<float>& mask = set.photographs[view].mask;
      for (size_t t = 0; t < mask.size(); ++t) {
        shadows[view][width * static_cast<size_t>(first) + t] = mask[t] == 0;
      }
    });
  }
  shadows_ = std::move(shadows);
}

PhotographSet SampleSource::PhotographRows(int first_row, int rows, int threads) {
  PhotographSet set = SharpenedRows(first_row, rows, threads);
  const size_t first = static_cast<size_t>(first_row) * static_cast<size_t>(plane().width);
  ForEachPiece(static_cast<int>(shadows_.size()), threads, [&](int piece) {
    const auto view = static_cast<size_t>(piece);
    std::vector<float>& mask = set.photographs[view].mask;
    for (size_t t = 0; t < mask.size(); ++t) {
      if (shadows_[view][first + t]) mask[t] = 0.0f;
    }
  });
  return set;
}

PhotographSet SampleSource::SharpenedRows(int first_row, int rows, int threads) {
  const int above = std::min(first_row, shared_detail_.RowsAbout());
  const int below = std::min(plane().height - first_row - rows, shared_detail_.RowsAbout());
  PhotographSet set = CorrectedRows(first_row - above, above + rows + below, threads);
  shared_detail_.AddTo(&set, threads);
  Cut(above, rows, plane().Rows(first_row, rows), &set);
  return set;
}

PhotographSet SampleSource::CorrectedRows(int first_row, int rows, int threads) {
  if (corrections_.views.empty()) return photographs_.Rows(first_row, rows, threads);
  const int reached = RowsReached(corrections_);
  const int above = std::min(first_row, reached);
  const int below = std::min(plane().height - first_row - rows, reached);
  PhotographSet set = Corrected(photographs_.Rows(first_row - above, above + rows + below, threads),
                                corrections_, threads);
  Cut(above, rows, plane().Rows(first_row, rows), &set);
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
