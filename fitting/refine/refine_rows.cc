#include "fitting/refine/refine_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>
#include <utility>

#include "base/parallel/parallel.h"
#include "base/resampling/resampling.h"
#include "fitting/refine/confidence.h"
#include "fitting/refine/gather.h"
#include "fitting/refine/neighbours.h"
#include "fitting/refine/point_spread.h"
#include "fitting/refine/refine_worker.h"
#include "fitting/render/render_environment.h"
#include "fitting/render/render_lit.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

RefineProblem WithViews(RefineProblem problem, const std::vector<View>& views) {
  for (size_t v = 0; v < views.size(); ++v) problem.views[v].view = views[v];
  return problem;
}

// How far one Deblurred() looks, of all views.
int BlurredRows(const RefineProblem& problem, const RefineOptions& options) {
  int most = 0;
  for (const RefineView& view : problem.views) {
    most = std::max(most, 2 * PointSpread(view.pixels_per_texel, options.point_spread_px).reach());
  }
  return most;
}

// Rows about those that are asked for which a step must do, for the steps after it.
struct RowsAbout {
  RowsAbout(int neighbour_passes, int blurred_rows)
      : blurred(blurred_rows), starts(1 + neighbour_passes * (2 + blurred_rows)) {}
  // Of the first and second half pass, passes counting from 0; photographs are deblurred as far.
  int Half(int pass, int half) const { return starts - (pass + 1) * (2 + blurred) + 2 - half; }
  int blurred;
  int starts;
};

// Of narrow maps several rows are solved at once: texels that take long are solved together.
constexpr int kTexelsAtOnce = 1024;

// Some rows of the sample.
class PartRefiner {
 public:
  // `said`: views in the estimate's order, as they are said to be; the first `above` and the last
  // `below` rows are there for the others' sake. `count`: called by texels done.
  PartRefiner(const SampleEstimate& estimate, const RefineProblem& said, const SvbrdfMaps& start,
              const RefineOptions& options, int above, int below, int threads,
              std::function<void(int row)> count);
  void Run();

  RowRefiner::Rows& result() { return result_; }
  // One of RowSums.
  std::vector<double> SumsOf(int row) const;

 private:
  enum Origin : unsigned char { kConverged = 1, kOtherStart = 2, kNeighbour = 4, kUnseen = 8 };
  // Of the row's texels, how many have the flag.
  double Count(int row, Origin flag) const;
  size_t SumColumns() const { return 1 + 2 * problem_.views.size(); }
  void Deblur();
  // Of the rows asked for and of so many about them.
  void SolveFromStarts(int about);
  void SolveFromNeighbours(int half_pass, int about);
  BatchSearch::Task FromNeighbours(size_t texel) const;
  void Conclude();
  void ConcludeBatch(std::span<const size_t> texels, RefineWorker* worker);
  void ConcludeTexel(size_t texel, int lane, const BatchGram& photographs,
                     const BatchInverse& inverse, const RefineWorker& worker);
  // A few rows at a time.
  void ForEachRows(int about,
                   const std::function<void(int begin, int end, RefineWorker* worker)>& visit);
  const BatchObservations* Gather(std::span<const size_t> texels,
                                  BatchObservations* observations) const;
  TexelPrior PriorOf(size_t texel) const { return model_.PriorOf(texel, result_.maps); }
  void Keep(size_t texel, const TexelSolution& solution);

  std::vector<int> all_views_;
  const SamplePart part_;
  const SampleModel model_;
  RefineProblem problem_;  // views with their deviations
  const int blurred_rows_;
  std::vector<std::vector<float>> deblurred_;  // by view; empty: it has no blur
  const SvbrdfMaps& start_;
  const RefineOptions& options_;
  const int threads_;
  const int first_row_;      // in the whole sample
  const int above_, below_;  // rows that were not asked for
  const std::function<void(int row)> count_;
  std::vector<std::unique_ptr<RefineWorker>> workers_;
  RowRefiner::Rows result_;
  std::vector<unsigned char> origin_;
  std::vector<float> start_costs_;
  std::vector<double> sums_;  // by row: cost, log differences and their number by view
};

PartRefiner::PartRefiner(const SampleEstimate& estimate, const RefineProblem& said,
                         const SvbrdfMaps& start, const RefineOptions& options, int above,
                         int below, int threads, std::function<void(int row)> count)
    : all_views_(said.views.size()),
      part_(said, start, estimate.substances, threads),
      model_(estimate.model.On(part_)),
      problem_(WithViews(said, estimate.found)),
      blurred_rows_(BlurredRows(said, options)),
      deblurred_(said.views.size()),
      start_(start),
      options_(options),
      threads_(threads),
      first_row_(said.plane.whole.first_row),
      above_(above),
      below_(below),
      count_(std::move(count)),
      workers_(RefineWorkers(said, options, threads)) {
  std::iota(all_views_.begin(), all_views_.end(), 0);
  for (auto& worker : workers_) {
    worker->batches.SetNoise(std::sqrt(model_.residuals().variance()));
  }
  result_.maps = start;
  result_.confidence.assign(start.texels() * kConfidencePlanes, 0.0f);
  origin_.assign(start.texels(), 0);
  start_costs_.assign(start.texels(), 0.0f);
  sums_.assign(static_cast<size_t>(start.height) * SumColumns(), 0.0);
}

void PartRefiner::ForEachRows(int about,
                              const std::function<void(int begin, int end, RefineWorker*)>& visit) {
  std::mutex mutex;
  const int from = std::max(0, above_ - about);
  const int end = std::min(start_.height, start_.height - below_ + about);
  const int rows = std::max(1, kTexelsAtOnce / start_.width);
  ForEachPieceByWorker((end - from + rows - 1) / rows, threads_, [&](int piece, int worker) {
    const int first = from + piece * rows, last = std::min(end, first + rows);
    visit(first, last, workers_[static_cast<size_t>(worker)].get());
    const std::lock_guard lock(mutex);
    for (int row = first; row < last; ++row) count_(row);
  });
}

const BatchObservations* PartRefiner::Gather(std::span<const size_t> texels,
                                             BatchObservations* observations) const {
  GatherObservations(problem_, start_, texels, all_views_, observations);
  return observations;
}

void PartRefiner::Keep(size_t texel, const TexelSolution& solution) {
  WriteTexel(solution.values, texel, &result_.maps);
  origin_[texel] = static_cast<unsigned char>((origin_[texel] & ~kConverged) |
                                              (solution.converged ? kConverged : 0));
}

// Of all views, by the maps as they are now.
void PartRefiner::Deblur() {
  if (blurred_rows_ == 0) return;
  const int width = start_.width, height = start_.height;
  ForEachPiece(static_cast<int>(problem_.views.size()), threads_, [&](int v) {
    RefineView& view = problem_.views[static_cast<size_t>(v)];
    const PointSpread spread(view.pixels_per_texel, options_.point_spread_px);
    if (spread.none()) return;
    std::vector<float> rendering(3 * start_.texels());
    RenderLit(result_.maps, problem_.plane, view.view, problem_.convention, rendering.data());
    AddEnvironmentLighting(problem_.environment, result_.maps, problem_.plane, view.view,
                           problem_.convention, rendering.data());
    std::vector<float>& deblurred = deblurred_[static_cast<size_t>(v)];
    deblurred =
        Deblurred(spread, view.rgb, view.mask, view.ldr, std::move(rendering), width, height);
    view.deblurred = deblurred;
  });
}

void PartRefiner::SolveFromStarts(int about) {
  const size_t width = static_cast<size_t>(start_.width);
  ForEachRows(about, [&](int begin, int end, RefineWorker* worker) {
    BatchSearch& batches = worker->batches;
    batches.Begin(
        BatchSearch::From::kStart,
        [&](std::span<const size_t> texels, BatchObservations* seen) {
          return Gather(texels, seen);
        },
        [&](const BatchSearch::Task& task, const BatchSearch::Found& found) {
          if (found.views == 0) {
            origin_[task.id] = kConverged | kUnseen;  // the initial values stay
            return;
          }
          start_costs_[task.id] = static_cast<float>(found.solution.start_cost);
          if (found.other_start) origin_[task.id] |= kOtherStart;
          Keep(task.id, found.solution);
        });
    for (size_t texel = static_cast<size_t>(begin) * width;
         texel < static_cast<size_t>(end) * width; ++texel) {
      batches.Add({.id = texel, .prior = model_.PriorOf(texel), .start = ReadTexel(start_, texel)});
    }
    batches.Finish();
  });
}

// One colour of the checkerboard: the neighbours of a texel all have the other, and stand still.
// Half passes count from 1.
void PartRefiner::SolveFromNeighbours(int half_pass, int about) {
  const int width = start_.width;
  ForEachRows(about, [&](int begin, int end, RefineWorker* worker) {
    BatchSearch& batches = worker->batches;
    batches.Begin(
        BatchSearch::From::kNeighbours,
        [&](std::span<const size_t> texels, BatchObservations* seen) {
          return Gather(texels, seen);
        },
        [&](const BatchSearch::Task& task, const BatchSearch::Found& found) {
          if (found.other_start) origin_[task.id] |= kNeighbour;
          Keep(task.id, found.solution);
        });
    for (int row = begin; row < end; ++row) {
      for (int column = (first_row_ + row + half_pass) % 2; column < width; column += 2) {
        const size_t texel =
            static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column);
        if (origin_[texel] & kUnseen) continue;
        batches.Add(FromNeighbours(texel));
      }
    }
    batches.Finish();
  });
}

// The prior is no longer the one that the texel was solved with.
BatchSearch::Task PartRefiner::FromNeighbours(size_t texel) const {
  BatchSearch::Task task{.id = texel,
                         .prior = PriorOf(texel),
                         .start = ReadTexel(result_.maps, texel),
                         .converged = (origin_[texel] & kConverged) != 0};
  ForEachNeighbour(texel, start_.width, start_.height, [&](size_t neighbour) {
    task.neighbours[static_cast<size_t>(task.neighbour_count++)] =
        ReadTexel(result_.maps, neighbour);
  });
  return task;
}

// Confidence and the texel's share of the summary, of one lane.
void PartRefiner::ConcludeTexel(size_t texel, int lane, const BatchGram& photographs,
                                const BatchInverse& inverse, const RefineWorker& worker) {
  const size_t texels = start_.texels(), views = problem_.views.size();
  TexelCovariance covariance =
      PosteriorCovariance(inverse, lane, model_.measured_residuals().scale());
  const TexelValues values = ReadTexel(result_.maps, texel);
  covariance += model_.CommonCovariance(texel, inverse, lane);
  covariance += model_.CorrelatedPriorCovariance(texel, values, inverse, lane);
  covariance += SystematicCovariance(problem_.systematic_sd, values);
  const double squares = photographs.Squares(lane);
  const auto planes = TexelConfidence(covariance, values, squares);
  for (int p = 0; p < kConfidencePlanes; ++p) result_.confidence[p * texels + texel] = planes[p];

  double* sum = &sums_[texel / static_cast<size_t>(start_.width) * SumColumns()];
  sum[0] += 0.5 * (squares + PriorOf(texel).SquaredNorm(values));
  for (size_t v = 0; v < views; ++v) {
    const int view = static_cast<int>(v);
    if (!worker.observed.sees(view, lane)) continue;
    for (int c = 0; c < 3; ++c) {
      sum[1 + v] += std::abs(worker.residuals.at(view, c, BatchResiduals::kDifference, lane));
    }
    sum[1 + views + v] += 3.0;
  }
}

void PartRefiner::ConcludeBatch(std::span<const size_t> texels, RefineWorker* worker) {
  Gather(texels, &worker->observed);
  BatchValues values;
  BatchPrior prior;
  for (size_t i = 0; i < texels.size(); ++i) {
    const int lane = static_cast<int>(i);
    SetLane(lane, ReadTexel(result_.maps, texels[i]), &values);
    prior.SetLane(lane, model_.StatedPriorOf(texels[i]));
  }
  BatchEvaluator& evaluator = worker->batches.evaluator();
  BatchGram photographs;
  evaluator.Gram(worker->observed, values, &photographs, &worker->residuals);
  BatchInverse inverse;
  evaluator.Inverse(photographs, prior, values,
                    LeastInformation(model_.measured_residuals().scale()), &inverse);
  for (size_t i = 0; i < texels.size(); ++i) {
    ConcludeTexel(texels[i], static_cast<int>(i), photographs, inverse, *worker);
  }
}

void PartRefiner::Conclude() {
  const size_t width = static_cast<size_t>(start_.width);
  ForEachRows(0, [&](int begin, int end_row, RefineWorker* worker) {
    const size_t end = static_cast<size_t>(end_row) * width;
    for (size_t first = static_cast<size_t>(begin) * width; first < end; first += kBatch) {
      std::array<size_t, kBatch> texels;
      std::iota(texels.begin(), texels.end(), first);
      ConcludeBatch(std::span(texels).first(std::min<size_t>(kBatch, end - first)), worker);
    }
  });
}

void PartRefiner::Run() {
  const RowsAbout rows(options_.neighbour_passes, blurred_rows_);
  Deblur();
  SolveFromStarts(rows.starts);
  for (int pass = 0; pass < options_.neighbour_passes; ++pass) {
    Deblur();
    for (const int half : {1, 2}) SolveFromNeighbours(2 * pass + half, rows.Half(pass, half));
  }
  Conclude();
}

double PartRefiner::Count(int row, Origin flag) const {
  const auto first = origin_.begin() + static_cast<std::ptrdiff_t>(row) * start_.width;
  return static_cast<double>(std::count_if(
      first, first + start_.width, [flag](unsigned char origin) { return (origin & flag) != 0; }));
}

std::vector<double> PartRefiner::SumsOf(int row) const {
  const auto begin = start_costs_.begin() + static_cast<std::ptrdiff_t>(row) * start_.width;
  std::vector<double> sums = {std::accumulate(begin, begin + start_.width, 0.0),
                              Count(row, kConverged), Count(row, kOtherStart),
                              Count(row, kNeighbour)};
  const double* more = &sums_[static_cast<size_t>(row) * SumColumns()];
  sums.insert(sums.end(), more, more + SumColumns());
  return sums;
}

}  // namespace

int DependentRows(const RefineProblem& problem, const RefineOptions& options) {
  const RowsAbout rows(options.neighbour_passes, BlurredRows(problem, options));
  return rows.starts + rows.blurred;
}

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

RowRefiner::RowRefiner(const SampleEstimate& estimate, const RefineOptions& options, int rows,
                       int threads, ReportProgress progress)
    : estimate_(estimate),
      options_(options),
      rows_(rows),
      threads_(std::max(threads, 1)),
      progress_(std::move(progress)) {}

RowRefiner::Rows RowRefiner::Refine(const RefineProblem& problem, const SvbrdfMaps& start,
                                    int above, int below) {
  const RefineProblem said = estimate_.InOrder(problem);
  const int first = above, last = start.height - below;
  const std::int64_t visits =
      static_cast<std::int64_t>(rows_) * start.width * (2 + 2 * options_.neighbour_passes);
  PartRefiner part(estimate_, said, start, options_, above, below, threads_, [&](int row) {
    if (row < first || row >= last) return;
    done_ += start.width;
    if (progress_) progress_(done_, visits);
  });
  part.Run();
  for (int row = first; row < last; ++row) sums_.push_back(part.SumsOf(row));
  Rows& solved = part.result();
  if (first == 0 && last == start.height) return std::move(solved);
  Rows rows{SvbrdfMaps(start.width, last - first), {}};
  rows.maps.planes = CutRows(solved.maps.planes, start.width, start.height, first, last - first);
  rows.confidence = CutRows(solved.confidence, start.width, start.height, first, last - first);
  return rows;
}

}  // namespace glint
