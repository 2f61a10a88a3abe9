#include "fitting/refine/refine.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "base/parallel/parallel.h"
#include "fitting/refine/confidence.h"
#include "fitting/refine/gather.h"
#include "fitting/refine/highlight_pool.h"
#include "fitting/refine/refine_prior.h"
#include "fitting/texel/residual_noise.h"
#include "fitting/texel/texel_parameters.h"
#include "fitting/texel/texel_search.h"

namespace glint {
namespace {

constexpr int kTexelsPerPiece = 256;
constexpr double kTypicalSigma = 0.02;  // of residuals, where too few views leave it open

void CheckProblem(const RefineProblem& problem, const SvbrdfMaps& start) {
  const SamplePlane& plane = problem.plane;
  const size_t texels = static_cast<size_t>(plane.width) * plane.height;
  if (problem.views.empty()) throw std::invalid_argument("refine: no photographs");
  if (start.width != plane.width || start.height != plane.height) {
    throw std::invalid_argument("refine: the start's size is not the photographs'");
  }
  for (const RefineView& view : problem.views) {
    if (view.rgb.size() != 3 * texels || view.mask.size() != texels) {
      throw std::invalid_argument("refine: a photograph's size is not the plane's");
    }
  }
  const auto finite = [](float x) { return std::isfinite(x); };
  if (!std::all_of(start.planes.begin(), start.planes.end(), finite)) {
    throw std::invalid_argument("refine: the start has values that are not finite");
  }
}

// The same sums whatever the order in which the photographs were given.
std::vector<int> CanonicalOrder(const std::vector<RefineView>& views) {
  std::vector<int> order(views.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  const auto key = [&](int i) {
    const View& v = views[i].view;
    return std::tie(v.camera_in_sample_mm, v.light_in_sample_mm, v.light_rgb, v.ambient_rgb,
                    v.exposure);
  };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  return order;
}

// What one thread owns.
struct Worker {
  Worker(const KernelOptions& options, const RefineOptions& refine, int views)
      : observations(views),
        search(options, refine.iterations, views, refine.starts),
        differences(3 * static_cast<size_t>(views)) {}
  TexelObservations observations;
  TexelSearch search;
  std::vector<double> differences;
};

// One refinement in progress.
class Refiner {
 public:
  Refiner(const RefineProblem& problem, const SvbrdfMaps& start, const RefineOptions& options,
          int threads, const std::function<void(std::int64_t, std::int64_t)>& progress);
  RefineResult Run();

 private:
  void EstimateNoise();
  void SolveFromStarts();
  void SolveFromNeighbours(int half_pass);
  void Conclude();
  void ConcludeTexel(size_t texel, Worker* worker);
  size_t SumColumns() const { return 1 + 2 * problem_.views.size(); }

  void ForEachTexel(const std::function<void(size_t texel, Worker* worker)>& visit);
  PriorWeights WeightsAt(size_t texel) const;
  TexelSolution Current(size_t texel, const TexelPrior& prior, Worker* worker);
  void Keep(size_t texel, const TexelSolution& solution);

  RefineProblem problem_;  // views in canonical order
  std::vector<int> order_;
  const SvbrdfMaps& start_;
  const RefineOptions& options_;
  const int threads_;
  const std::function<void(std::int64_t, std::int64_t)>& progress_;
  std::int64_t done_ = 0;
  std::mutex progress_mutex_;

  KernelOptions kernel_;
  std::vector<std::unique_ptr<Worker>> workers_;
  PriorWeights weights_;
  RefineResult result_;
  enum Origin : unsigned char { kConverged = 1, kOtherStart = 2, kNeighbour = 4, kConcluded = 8 };
  std::vector<unsigned char> origin_;
  std::vector<int> changed_;  // half pass in which a texel last changed; 0: its own start
  // Sums by piece, added up in the pieces' order.
  std::vector<double> start_costs_;
  std::vector<double> sums_;  // cost, then log differences and their number by view
};

Refiner::Refiner(const RefineProblem& problem, const SvbrdfMaps& start,
                 const RefineOptions& options, int threads,
                 const std::function<void(std::int64_t, std::int64_t)>& progress)
    : problem_(problem),
      order_(CanonicalOrder(problem.views)),
      start_(start),
      options_(options),
      threads_(std::max(threads, 1)),
      progress_(progress) {
  for (size_t i = 0; i < order_.size(); ++i) problem_.views[i] = problem.views[order_[i]];
  kernel_.diffuse_weight = problem.convention.diffuse_weight;
  kernel_.robust_scale = options.robust_scale;
  for (int i = 0; i < threads_; ++i) {
    workers_.push_back(
        std::make_unique<Worker>(kernel_, options, static_cast<int>(problem.views.size())));
  }
  result_.maps = start;
  result_.confidence.assign(start.texels() * kConfidencePlanes, 0.0f);
  origin_.assign(start.texels(), 0);
  changed_.assign(start.texels(), 0);
  const size_t pieces = (start.texels() + kTexelsPerPiece - 1) / kTexelsPerPiece;
  start_costs_.assign(pieces, 0.0);
  sums_.assign(pieces * SumColumns(), 0.0);
}

void Refiner::ForEachTexel(const std::function<void(size_t, Worker*)>& visit) {
  const size_t texels = start_.texels();
  const int pieces = static_cast<int>((texels + kTexelsPerPiece - 1) / kTexelsPerPiece);
  const std::int64_t visits =
      static_cast<std::int64_t>(texels) * (2 + 2 * options_.neighbour_passes);
  ForEachPieceByWorker(pieces, threads_, [&](int piece, int worker) {
    const size_t first = static_cast<size_t>(piece) * kTexelsPerPiece;
    const size_t last = std::min(first + kTexelsPerPiece, texels);
    for (size_t texel = first; texel < last; ++texel) visit(texel, workers_[worker].get());
    const std::lock_guard lock(progress_mutex_);
    done_ += static_cast<std::int64_t>(last - first);
    if (progress_) progress_(done_, visits);
  });
}

void Refiner::EstimateNoise() {
  RefineSummary& summary = result_.summary;
  summary.distinct_views = DistinctViews(problem_);
  constexpr size_t kSampled = 512;
  const size_t texels = start_.texels();
  const size_t sampled = std::min(kSampled, texels);
  const PriorWeights weak = HoldToStart(1.0, 0.005, summary.distinct_views, {});
  std::vector<double> variances(sampled, -1.0);
  std::vector<ResidualNoise> noise(sampled);
  ForEachPieceByWorker(static_cast<int>(sampled), threads_, [&](int i, int worker) {
    Worker& w = *workers_[worker];
    const size_t texel = texels * i / sampled;
    GatherObservations(problem_, start_, texel, &w.observations);
    const int freedom = 3 * w.observations.views() - kTexelParameters;
    if (freedom < 6) return;
    const TexelValues start = ReadTexel(start_, texel);
    const TexelPrior prior(weak, start);
    const TexelSolution solution = w.search.FromStart(w.observations, prior, start).solution;
    variances[i] = (2.0 * solution.cost - prior.SquaredNorm(solution.values)) / freedom;
    w.search.solver().Cost(w.observations, prior, solution.values);  // for its residuals
    noise[i].Add(w.search.solver().rows(), w.observations.views(), variances[i]);
  });
  ResidualNoise all;
  for (const ResidualNoise& one : noise) all.Add(one);
  summary.shared_noise = all.Shared();
  std::erase_if(variances, [](double v) { return v < 0.0; });
  summary.residual_sigma = kTypicalSigma;
  if (variances.size() >= sampled / 4 && !variances.empty()) {
    const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
    std::nth_element(variances.begin(), middle, variances.end());
    summary.residual_sigma = std::sqrt(std::max(*middle, 1e-8));
  }
  for (auto& worker : workers_) worker->search.SetNoise(summary.residual_sigma);
  weights_ = HoldToStart(options_.prior, summary.holding_sigma(), summary.distinct_views, {});
}

PriorWeights Refiner::WeightsAt(size_t texel) const {
  PriorWeights weights = weights_;
  if (!problem_.roughness_error.empty()) {
    weights.errors.roughness = problem_.roughness_error[texel];
    weights.errors.specular = problem_.specular_error[texel];
    weights.errors.specular_relative = 0;
  }
  return weights;
}

TexelSolution Refiner::Current(size_t texel, const TexelPrior& prior, Worker* worker) {
  TexelSolution solution;
  solution.values = ReadTexel(result_.maps, texel);
  solution.cost = worker->search.solver().Cost(worker->observations, prior, solution.values);
  solution.converged = (origin_[texel] & kConverged) != 0;
  return solution;
}

void Refiner::Keep(size_t texel, const TexelSolution& solution) {
  WriteTexel(solution.values, texel, &result_.maps);
  origin_[texel] = static_cast<unsigned char>((origin_[texel] & ~kConverged) |
                                              (solution.converged ? kConverged : 0));
}

void Refiner::SolveFromStarts() {
  ForEachTexel([&](size_t texel, Worker* worker) {
    GatherObservations(problem_, start_, texel, &worker->observations);
    if (worker->observations.views() == 0) {
      origin_[texel] = kConverged;  // nothing to learn: the start stays
      ConcludeTexel(texel, worker);
      return;
    }
    const TexelValues start = ReadTexel(start_, texel);
    const TexelPrior prior(WeightsAt(texel), start);
    const TexelSearch::Found found = worker->search.FromStart(worker->observations, prior, start);
    start_costs_[texel / kTexelsPerPiece] += found.start_cost;
    if (found.other_start) origin_[texel] |= kOtherStart;
    Keep(texel, found.solution);
    // Neighbours are not asked where noise explains all: such texels are done.
    if (!worker->search.Unexplained(worker->observations.views(), found.solution.cost)) {
      ConcludeTexel(texel, worker);
    }
  });
}

// One colour of the checkerboard: the neighbours of a texel all have the other, and stand still.
// Half passes count from 1; later ones pass over texels round which nothing changed since.
void Refiner::SolveFromNeighbours(int half_pass) {
  const int width = start_.width, height = start_.height;
  const auto changed_since = [&](size_t texel) { return changed_[texel] >= half_pass - 2; };
  ForEachTexel([&](size_t texel, Worker* worker) {
    const int column = static_cast<int>(texel % width);
    const int row = static_cast<int>(texel / width);
    if ((row + column + half_pass) % 2 != 0 || (origin_[texel] & kConcluded)) return;
    std::array<TexelValues, 4> neighbours;
    size_t count = 0;
    bool any_change = changed_since(texel);
    const auto add = [&](int r, int c) {
      if (r < 0 || r >= height || c < 0 || c >= width) return;
      const size_t neighbour = static_cast<size_t>(r) * width + c;
      any_change = any_change || changed_since(neighbour);
      neighbours[count++] = ReadTexel(result_.maps, neighbour);
    };
    add(row - 1, column);
    add(row, column - 1);
    add(row, column + 1);
    add(row + 1, column);
    if (!any_change) return;
    GatherObservations(problem_, start_, texel, &worker->observations);
    const TexelPrior prior(WeightsAt(texel), ReadTexel(start_, texel));
    const TexelSolution current = Current(texel, prior, worker);
    const TexelSearch::Found found = worker->search.FromNeighbours(
        worker->observations, prior, current, std::span(neighbours).first(count));
    if (!found.other_start) return;
    origin_[texel] |= kNeighbour;
    changed_[texel] = half_pass;
    Keep(texel, found.solution);
  });
}

// Confidence and the texel's share of the summary, from the observations that `worker` holds.
void Refiner::ConcludeTexel(size_t texel, Worker* worker) {
  origin_[texel] |= kConcluded;
  const size_t texels = start_.texels();
  const size_t views = problem_.views.size();
  const TexelValues values = ReadTexel(result_.maps, texel);
  const TexelValues start = ReadTexel(start_, texel);
  // The start is believed as far as its expected errors say: not held harder, as the fit does.
  const PriorWeights believed =
      options_.prior > 0.0 ? BelieveStart(result_.summary.telling_sigma(), {}) : PriorWeights{};
  TexelGram gram;
  worker->search.solver().Gram(worker->observations, TexelPrior({}, start), values, &gram);
  const double squares = gram[kTexelParameters][kTexelParameters];
  TexelPrior(believed, values).AddTo(values, &gram);
  const auto planes = TexelConfidence(gram, values, 3 * worker->observations.views(),
                                      result_.summary.residual_sigma, result_.summary.shared_noise);
  for (int p = 0; p < kConfidencePlanes; ++p) result_.confidence[p * texels + texel] = planes[p];

  double* sum = &sums_[texel / kTexelsPerPiece * SumColumns()];
  sum[0] += 0.5 * (squares + TexelPrior(WeightsAt(texel), start).SquaredNorm(values));
  const KernelRows& rows = worker->search.solver().rows();
  const int usable = worker->observations.views();
  std::vector<double>& differences = worker->differences;
  for (int c = 0; c < 3; ++c) {
    LogDifferences(rows.row(c, KernelRows::kResidual), usable, kernel_.robust_scale,
                   differences.data() + c * usable);
  }
  int row = 0;
  for (size_t v = 0; v < views; ++v) {
    if (!(problem_.views[v].mask[texel] >= 0.5f)) continue;
    for (int c = 0; c < 3; ++c) sum[1 + v] += differences[c * usable + row];
    sum[1 + views + v] += 3.0;
    ++row;
  }
}

void Refiner::Conclude() {
  const size_t texels = start_.texels();
  const size_t views = problem_.views.size();
  ForEachTexel([&](size_t texel, Worker* worker) {
    if (origin_[texel] & kConcluded) return;
    GatherObservations(problem_, start_, texel, &worker->observations);
    ConcludeTexel(texel, worker);
  });
  const size_t columns = SumColumns();
  std::vector<double> total(columns, 0.0);
  for (size_t i = 0; i < sums_.size(); ++i) total[i % columns] += sums_[i];
  RefineSummary& summary = result_.summary;
  for (const double cost : start_costs_) summary.start_cost += cost;
  summary.start_cost /= static_cast<double>(texels);
  summary.final_cost = total[0] / static_cast<double>(texels);
  summary.view_loss.assign(views, 0.0);
  for (size_t v = 0; v < views; ++v) {
    summary.view_loss[order_[v]] = total[1 + v] / total[1 + views + v];
  }
  const auto share = [&](unsigned char flag) {
    const auto has = [flag](unsigned char o) { return (o & flag) != 0; };
    return static_cast<double>(std::count_if(origin_.begin(), origin_.end(), has)) /
           static_cast<double>(texels);
  };
  summary.converged = share(kConverged);
  summary.other_start = share(kOtherStart);
  summary.neighbour = share(kNeighbour);
}

RefineResult Refiner::Run() {
  EstimateNoise();
  SolveFromStarts();
  for (int half = 1; half <= 2 * options_.neighbour_passes; ++half) SolveFromNeighbours(half);
  Conclude();
  return std::move(result_);
}

}  // namespace

std::string RefineOptions::Check() const {
  if (iterations < 1) return "iterations must be at least 1";
  if (starts < 1) return "starts must be at least 1";
  if (pooling_passes < 0) return "pooling passes must be at least 0";
  if (neighbour_passes < 0) return "neighbour passes must be at least 0";
  if (!(prior >= 0.0)) return "the prior's weight must be at least 0";
  if (!(robust_scale > 0.0)) return "the robust scale must be above 0";
  return "";
}

std::string RefineSummary::BriefReport() const {
  std::ostringstream text;
  text.precision(4);
  text << "cost " << start_cost << " -> " << final_cost << " per texel, " << 100.0 * converged
       << " % converged, residual sigma " << residual_sigma << " (shared " << shared_noise << "), "
       << distinct_views << " distinct views, " << 100.0 * other_start << " % from another start, "
       << 100.0 * neighbour << " % from a neighbour";
  return text.str();
}

RefineResult Refine(const RefineProblem& problem, const SvbrdfMaps& start,
                    const RefineOptions& options, int threads,
                    const std::function<void(std::int64_t, std::int64_t)>& progress) {
  const std::string wrong = options.Check();
  if (!wrong.empty()) throw std::invalid_argument("refine: " + wrong);
  CheckProblem(problem, start);
  // Progress of all passes as of one long one.
  const bool pools = static_cast<int>(problem.views.size()) >= kPoolingViews;
  const int passes = pools ? options.pooling_passes : 0;
  int pass = 0;
  const auto report = [&](std::int64_t done, std::int64_t total) {
    if (progress) progress(pass * total + done, (passes + 1) * total);
  };
  RefineResult result = Refiner(problem, start, options, threads, report).Run();
  const double start_cost = result.summary.start_cost;
  for (pass = 1; pass <= passes; ++pass) {
    const HighlightPool pool = PoolHighlights(result, {}, threads);
    RefineProblem pooled = problem;
    pooled.roughness_error = pool.roughness_error;
    pooled.specular_error = pool.specular_error;
    result = Refiner(pooled, pool.start, options, threads, report).Run();
  }
  result.summary.start_cost = start_cost;
  return result;
}

}  // namespace glint
