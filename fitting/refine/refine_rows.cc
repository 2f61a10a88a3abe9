#include "fitting/refine/refine_rows.h"

#include <algorithm>
#include <span>
#include <utility>

#include "base/resampling/resampling.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

// Relief is found of so many rows at once.
constexpr int kReliefRows = 2 * kMostTileSide;
constexpr int kSlopeRows = 64;
// Of a texel between steps: its maps, and PartRefiner's flags.
constexpr int kSolvedPlanes = kSvbrdfPlanes + 1;

RowSpan Widened(RowSpan rows, int about, int height) {
  return {std::max(rows.first - about, 0), std::min(rows.last + about, height)};
}

bool HasRelief(const SampleEstimate& estimate, const SamplePlane& plane) {
  return estimate.model.finds_relief() && SampleHasRelief(plane.width, plane.height);
}

// Slopes n_x/n_z and n_y/n_z of the texels.
std::array<std::vector<float>, 2> SlopesOf(const SvbrdfMaps& maps) {
  std::array<std::vector<float>, 2> slopes;
  for (size_t t = 0; t < maps.texels(); ++t) {
    const TexelValues values = ReadTexel(maps, t);
    slopes[0].push_back(static_cast<float>(values[kSlopeX]));
    slopes[1].push_back(static_cast<float>(values[kSlopeY]));
  }
  return slopes;
}

}  // namespace

RefineSummary Summarise(const SampleEstimate& estimate, const RowSums& rows, int width) {
  RefineSummary summary = estimate.summary;
  const size_t views = estimate.order.size();
  const size_t by_view = RowSumColumns(0);  // where log differences begin
  std::vector<double> sums(RowSumColumns(views), 0.0);
  for (const std::vector<double>& row : rows) {
    for (size_t i = 0; i < sums.size(); ++i) sums[i] += row[i];
  }
  const double texels = static_cast<double>(rows.size()) * width;
  summary.start_cost = sums[0] / texels;
  summary.converged = sums[1] / texels;
  summary.other_start = sums[2] / texels;
  summary.neighbour = sums[3] / texels;
  summary.final_cost = sums[4] / texels;
  summary.view_loss.assign(views, 0.0);
  for (size_t v = 0; v < views; ++v) {
    summary.view_loss[static_cast<size_t>(estimate.order[v])] =
        sums[by_view + v] / sums[by_view + views + v];
  }
  return summary;
}

RowRefiner::RowRefiner(const SampleEstimate& estimate, const RefineOptions& options,
                       const RefineProblem& sample, RowSpan asked,
                       const std::filesystem::path& scratch, int threads, ReportProgress progress)
    : estimate_(estimate),
      options_(options),
      sample_(estimate.InOrder(sample)),
      threads_(std::max(threads, 1)),
      progress_(std::move(progress)),
      has_relief_(HasRelief(estimate, sample.plane)),
      rows_(static_cast<size_t>(steps())),
      solved_{ScratchRows(scratch, sample.plane.width, kSolvedPlanes),
              ScratchRows(scratch, sample.plane.width, kSolvedPlanes)},
      relief_(scratch, sample.plane.width, 2) {
  rows_.back() = asked;
  for (int step = steps() - 1; step > 0; --step) {
    const RowSpan about = Widened(RowsOf(step), RowsAbout(step), sample.plane.height);
    const bool by_relief = has_relief_ && step < steps() - 1;
    rows_[static_cast<size_t>(step) - 1] =
        by_relief ? RowsOfRelief(sample.plane.height, about) : about;
  }
  for (int step = 0; step < steps(); ++step) {
    const int times = step == 0 || step == steps() - 1 ? 1 : 2;  // a pass goes over halves
    visits_ += static_cast<std::int64_t>(times) * RowsOf(step).size() * sample.plane.width;
  }
}

int RowRefiner::RowsAbout(int step) const {
  if (step == 0) return RowsAboutStarts(sample_, options_);
  return step == steps() - 1 ? RowsAboutConclusion(sample_, options_)
                             : RowsAboutPass(sample_, options_);
}

void RowRefiner::Take(const RefineProblem& problem, const SvbrdfMaps& start, int above, int below) {
  const int last = start.height - below;
  part_.reset(new Part{estimate_.InOrder(problem), problem.plane.whole.first_row, start.height,
                       above, below, std::nullopt});
  part_->refiner.emplace(estimate_, part_->said, start, options_, above, below, threads_,
                         [=, this](int row) {
                           if (row < above || row >= last) return;
                           done_ += sample_.plane.width;
                           if (progress_) progress_(done_, visits_);
                         });
}

void RowRefiner::Write(int step, const SolvedTexels& solved) {
  std::vector<float> planes(solved.maps.planes);
  planes.insert(planes.end(), solved.origin.begin(), solved.origin.end());
  const int rows = part_->height - part_->above - part_->below;
  solved_[static_cast<size_t>(step % 2)].Write(
      part_->first_row + part_->above,
      CutRows(planes, solved.maps.width, part_->height, part_->above, rows));
}

// As the step left them.
SolvedTexels RowRefiner::Read(int step, RowSpan rows) const {
  std::vector<float> planes = solved_[static_cast<size_t>(step % 2)].Read(rows.first, rows.size());
  SolvedTexels solved{SvbrdfMaps(sample_.plane.width, rows.size()), {}};
  const auto flags =
      planes.begin() + static_cast<std::ptrdiff_t>(kSvbrdfPlanes * solved.maps.texels());
  solved.origin.assign(flags, planes.end());
  planes.erase(flags, planes.end());
  solved.maps.planes = std::move(planes);
  return solved;
}

// Of all rows' texels as the step left them, a few rows in memory.
std::array<std::vector<float>, 2> RowRefiner::SlopesAfter(int step, RowSpan rows) const {
  std::array<std::vector<float>, 2> slopes;
  for (int first = rows.first; first < rows.last; first += kSlopeRows) {
    const auto some = SlopesOf(Read(step, {first, std::min(first + kSlopeRows, rows.last)}).maps);
    for (size_t i = 0; i < 2; ++i)
      slopes[i].insert(slopes[i].end(), some[i].begin(), some[i].end());
  }
  return slopes;
}

// Of the texels as the step before left them.
void RowRefiner::FindRelief(int step) {
  const SamplePlane& plane = sample_.plane;
  const RowSpan all = Widened(RowsOf(step), RowsAbout(step), plane.height);
  for (int first = all.first; first < all.last; first += kReliefRows) {
    const RowSpan some{first, std::min(first + kReliefRows, all.last)};
    const auto slopes = SlopesAfter(step - 1, RowsOfRelief(plane.height, some));
    auto relief = SlopesOfRelief({slopes[0], slopes[1]}, plane.width, plane.height,
                                 estimate_.model.facet_variance(), some, threads_);
    relief[0].insert(relief[0].end(), relief[1].begin(), relief[1].end());
    relief_.Write(first, relief[0]);
  }
  relief_of_ = step;
}

// Of the rows in hand; none where none is known.
std::array<std::vector<float>, 2> RowRefiner::Relief() const {
  if (relief_of_ == 0) return {};
  const std::vector<float> planes = relief_.Read(part_->first_row, part_->height);
  const auto middle = planes.begin() + static_cast<std::ptrdiff_t>(planes.size() / 2);
  return {std::vector<float>(planes.begin(), middle), std::vector<float>(middle, planes.end())};
}

std::optional<RowRefiner::Rows> RowRefiner::Do(int step) {
  PartRefiner& part = *part_->refiner;
  if (step == steps() - 1) return Conclude();
  if (step == 0) {
    Write(step, part.SolveFromStarts());
    const std::vector<double> costs = part.start_costs();
    start_costs_.insert(start_costs_.end(), costs.begin(), costs.end());
    return std::nullopt;
  }
  if (has_relief_ && relief_of_ != step) FindRelief(step);
  Write(step, part.Pass(Read(step - 1, part_->rows()), Relief()));
  return std::nullopt;
}

RowRefiner::Rows RowRefiner::Conclude() {
  PartRefiner& part = *part_->refiner;
  const int above = part_->above, last = part_->height - part_->below;
  Rows concluded = part.Conclude(Read(steps() - 2, part_->rows()), Relief());
  for (int row = above; row < last; ++row) {
    std::vector<double>& sums = sums_.emplace_back(part.SumsOf(row));
    const int started = part_->first_row + row - RowsOf(0).first;
    sums.insert(sums.begin(), start_costs_[static_cast<size_t>(started)]);
  }
  const int width = sample_.plane.width;
  const auto cut = [&](const std::vector<float>& planes) {
    return CutRows(planes, width, part_->height, above, last - above);
  };
  Rows asked{SvbrdfMaps(width, last - above), cut(concluded.confidence)};
  asked.maps.planes = cut(concluded.maps.planes);
  return asked;
}

}  // namespace glint
