#include "fitting/refine/part_refiner.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <utility>

#include "base/parallel/parallel.h"
#include "base/reflectance/characteristic_curve.h"
#include "fitting/refine/confidence.h"
#include "fitting/refine/gather.h"
#include "fitting/refine/neighbours.h"
#include "fitting/refine/point_spread.h"
#include "fitting/refine/view_sharpness.h"
#include "fitting/render/render_environment.h"
#include "fitting/render/render_lit.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

RefineProblem WithViews(RefineProblem problem, const SampleEstimate& estimate) {
  for (size_t v = 0; v < estimate.found.size(); ++v) problem.views[v].view = estimate.found[v];
  WeighViews(estimate.model.residuals().variance(), &problem);
  return problem;
}

// How far one Deblurred() looks, of all views.
int BlurredRows(const RefineProblem& problem, const RefineOptions& options) {
  int most = 0;
  for (const RefineView& view : problem.views) {
    most = std::max(most, 2 * constants::kDeblurSteps * SpreadOf(view, options).reach());
  }
  return most;
}

// Of narrow maps several rows are solved at once: texels that take long are solved together.
constexpr int kTexelsAtOnce = 1024;

}  // namespace

int RowsAboutStarts(const RefineProblem& problem, const RefineOptions& options) {
  return BlurredRows(problem, options);
}

// The second half looks at the row beside, of the first half, which looks a row further.
int RowsAboutPass(const RefineProblem& problem, const RefineOptions& options) {
  return 1 + std::max(1, BlurredRows(problem, options));
}

int RowsAboutConclusion(const RefineProblem& problem, const RefineOptions& options) {
  return std::max(1, BlurredRows(problem, options));
}

PartRefiner::PartRefiner(const SampleEstimate& estimate, const RefineProblem& said,
                         const SvbrdfMaps& start, const RefineOptions& options, int above,
                         int below, int threads, std::function<void(int row)> count)
    : all_views_(said.views.size()),
      part_(said, start, estimate.substances, threads),
      model_(estimate.model.On(part_)),
      problem_(WithViews(said, estimate)),
      blurred_rows_(BlurredRows(said, options)),
      deblurred_(said.views.size()),
      start_(start),
      options_(options),
      threads_(threads),
      first_row_(said.plane.whole.first_row),
      above_(above),
      below_(below),
      count_(std::move(count)),
      workers_(RefineWorkers(problem_, options, threads)) {
  std::iota(all_views_.begin(), all_views_.end(), 0);
  for (auto& worker : workers_) {
    worker->batches.SetNoise(std::sqrt(model_.residuals().variance()));
  }
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
  WriteTexel(solution.values, texel, &now_.maps);
  now_.origin[texel] = static_cast<unsigned char>((now_.origin[texel] & ~kConverged) |
                                                  (solution.converged ? kConverged : 0));
}

// Of all views, by the maps as they are now.
void PartRefiner::Deblur() {
  if (blurred_rows_ == 0) return;
  const int width = start_.width, height = start_.height;
  ForEachPiece(static_cast<int>(problem_.views.size()), threads_, [&](int v) {
    RefineView& view = problem_.views[static_cast<size_t>(v)];
    const PointSpread spread = SpreadOf(view, options_);
    if (spread.none()) return;
    std::vector<float> rendering(3 * start_.texels());
    RenderLit(now_.maps, problem_.plane, view.view, problem_.convention, rendering.data());
    AddEnvironmentLighting(problem_.environment, now_.maps, problem_.plane, view.view,
                           problem_.convention, rendering.data());
    Record(view.view.curve, rendering);
    std::vector<float>& deblurred = deblurred_[static_cast<size_t>(v)];
    deblurred =
        Deblurred(spread, view.rgb, view.mask, view.ldr, std::move(rendering), width, height);
    view.deblurred = deblurred;
  });
}

SolvedTexels PartRefiner::SolveFromStarts() {
  const size_t width = static_cast<size_t>(start_.width);
  now_ = {start_, std::vector<unsigned char>(start_.texels(), 0)};
  start_costs_.assign(start_.texels(), 0.0f);
  Deblur();
  ForEachRows(0, [&](int begin, int end, RefineWorker* worker) {
    BatchSearch& batches = worker->batches;
    batches.Begin(
        BatchSearch::From::kStart,
        [&](std::span<const size_t> texels, BatchObservations* seen) {
          return Gather(texels, seen);
        },
        [&](const BatchSearch::Task& task, const BatchSearch::Found& found) {
          if (found.views == 0) {
            now_.origin[task.id] = kConverged | kUnseen;  // the initial values stay
            return;
          }
          start_costs_[task.id] = static_cast<float>(found.solution.start_cost);
          if (found.other_start) now_.origin[task.id] |= kOtherStart;
          Keep(task.id, found.solution);
        });
    for (size_t texel = static_cast<size_t>(begin) * width;
         texel < static_cast<size_t>(end) * width; ++texel) {
      batches.Add({.id = texel, .prior = model_.PriorOf(texel), .start = ReadTexel(start_, texel)});
    }
    batches.Finish();
  });
  return std::move(now_);
}

std::vector<double> PartRefiner::start_costs() const {
  std::vector<double> sums;
  for (int row = above_; row < start_.height - below_; ++row) {
    const auto begin = start_costs_.begin() + static_cast<std::ptrdiff_t>(row) * start_.width;
    sums.push_back(std::accumulate(begin, begin + start_.width, 0.0));
  }
  return sums;
}

TexelPrior PartRefiner::PriorOf(size_t texel) const {
  if (relief_[0].empty()) return model_.PriorOf(texel, now_.maps, nullptr);
  const ReliefSlope slope = {relief_[0][texel], relief_[1][texel]};
  return model_.PriorOf(texel, now_.maps, &slope);
}

SolvedTexels PartRefiner::Pass(SolvedTexels solved, std::array<std::vector<float>, 2> relief) {
  now_ = std::move(solved);
  relief_ = std::move(relief);
  Deblur();
  SolveHalf(1, 1);
  SolveHalf(0, 0);
  return std::move(now_);
}

// The neighbours of a texel all have the other colour, and stand still.
void PartRefiner::SolveHalf(int half, int about) {
  const int width = start_.width;
  ForEachRows(about, [&](int begin, int end, RefineWorker* worker) {
    BatchSearch& batches = worker->batches;
    batches.Begin(
        BatchSearch::From::kNeighbours,
        [&](std::span<const size_t> texels, BatchObservations* seen) {
          return Gather(texels, seen);
        },
        [&](const BatchSearch::Task& task, const BatchSearch::Found& found) {
          if (found.other_start) now_.origin[task.id] |= kNeighbour;
          Keep(task.id, found.solution);
        });
    for (int row = begin; row < end; ++row) {
      for (int column = (first_row_ + row + half) % 2; column < width; column += 2) {
        const size_t texel =
            static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column);
        if (now_.origin[texel] & kUnseen) continue;
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
                         .start = ReadTexel(now_.maps, texel),
                         .converged = (now_.origin[texel] & kConverged) != 0};
  ForEachNeighbour(texel, start_.width, start_.height, [&](size_t neighbour) {
    task.neighbours[static_cast<size_t>(task.neighbour_count++)] = ReadTexel(now_.maps, neighbour);
  });
  return task;
}

// Confidence and the texel's share of the summary, of one lane.
void PartRefiner::ConcludeTexel(size_t texel, int lane, const BatchGram& photographs,
                                const BatchInverse& inverse, const RefineWorker& worker) {
  const size_t texels = start_.texels(), views = problem_.views.size();
  TexelCovariance covariance =
      PosteriorCovariance(inverse, lane, model_.measured_residuals().scale());
  const TexelValues values = ReadTexel(now_.maps, texel);
  covariance += model_.CommonCovariance(texel, inverse, lane);
  covariance += model_.CorrelatedPriorCovariance(texel, values, inverse, lane);
  covariance += SystematicCovariance(problem_.systematic_sd, values);
  const double squares = photographs.Squares(lane);
  const auto planes = TexelConfidence(covariance, values, squares);
  for (int p = 0; p < kConfidencePlanes; ++p) confidence_[p * texels + texel] = planes[p];

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
    SetLane(lane, ReadTexel(now_.maps, texels[i]), &values);
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

PartRefiner::Result PartRefiner::Conclude(SolvedTexels solved,
                                          std::array<std::vector<float>, 2> relief) {
  now_ = std::move(solved);
  relief_ = std::move(relief);
  confidence_.assign(start_.texels() * kConfidencePlanes, 0.0f);
  sums_.assign(static_cast<size_t>(start_.height) * SumColumns(), 0.0);
  Deblur();
  const size_t width = static_cast<size_t>(start_.width);
  ForEachRows(0, [&](int begin, int end_row, RefineWorker* worker) {
    const size_t end = static_cast<size_t>(end_row) * width;
    for (size_t first = static_cast<size_t>(begin) * width; first < end; first += kBatch) {
      std::array<size_t, kBatch> texels;
      std::iota(texels.begin(), texels.end(), first);
      ConcludeBatch(std::span(texels).first(std::min<size_t>(kBatch, end - first)), worker);
    }
  });
  return {std::move(now_.maps), std::move(confidence_)};
}

double PartRefiner::Count(int row, Origin flag) const {
  const auto first = now_.origin.begin() + static_cast<std::ptrdiff_t>(row) * start_.width;
  return static_cast<double>(std::count_if(
      first, first + start_.width, [flag](unsigned char origin) { return (origin & flag) != 0; }));
}

std::vector<double> PartRefiner::SumsOf(int row) const {
  std::vector<double> sums = {Count(row, kConverged), Count(row, kOtherStart),
                              Count(row, kNeighbour)};
  const double* more = &sums_[static_cast<size_t>(row) * SumColumns()];
  sums.insert(sums.end(), more, more + SumColumns());
  return sums;
}

}  // namespace glint
