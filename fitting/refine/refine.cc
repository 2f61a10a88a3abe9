#include "fitting/refine/refine.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "base/parallel/parallel.h"
#include "fitting/refine/confidence.h"
#include "fitting/refine/gather.h"
#include "fitting/refine/sample_model.h"
#include "fitting/texel/texel_parameters.h"
#include "fitting/texel/texel_search.h"

namespace glint {
namespace {

constexpr int kTexelsPerPiece = 256;

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

RefineProblem InOrder(RefineProblem problem, const std::vector<int>& order) {
  const std::vector<RefineView> views = problem.views;
  for (size_t i = 0; i < order.size(); ++i) problem.views[i] = views[order[i]];
  return problem;
}

// What one thread owns.
struct Worker {
  Worker(const KernelOptions& options, const RefineOptions& refine, int views)
      : observations(views),
        search(options, refine.iterations, views, refine.starts),
        differences(3 * static_cast<size_t>(views)),
        nudged(kViewDeviations) {}
  TexelObservations observations;
  TexelSearch search;
  std::vector<double> differences;
  std::vector<std::vector<double>> nudged;  // residuals, views a step further off
};

// One refinement in progress.
class Refiner {
 public:
  Refiner(const RefineProblem& problem, const SvbrdfMaps& start, const RefineOptions& options,
          int threads, const std::function<void(std::int64_t, std::int64_t)>& progress);
  RefineResult Run();

 private:
  void EstimateModel();
  void SetViews(const ViewDeviations& deviations);
  std::vector<DeviationProducts> OfViews(size_t texel, const TexelValues& values,
                                         std::span<const int> views, Worker* worker);
  void SolveFromStarts();
  void SolveFromNeighbours(int half_pass);
  void Conclude();
  void ConcludeTexel(size_t texel, Worker* worker);
  size_t SumColumns() const { return 1 + 2 * problem_.views.size(); }

  void ForEachTexel(const std::function<void(size_t texel, Worker* worker)>& visit);
  TexelPrior PriorOf(size_t texel) const { return model_.PriorOf(texel, result_.maps); }
  TexelSolution Current(size_t texel, const TexelPrior& prior, Worker* worker);
  void Keep(size_t texel, const TexelSolution& solution);

  std::vector<int> order_;
  std::vector<int> all_views_;
  RefineProblem problem_;   // views in canonical order
  std::vector<View> said_;  // those, with lights where they are said to be
  // The problem with one deviation of every view a step further, where they are looked for.
  std::vector<RefineProblem> nudged_;
  const SvbrdfMaps& start_;
  const RefineOptions& options_;
  const int threads_;
  const std::function<void(std::int64_t, std::int64_t)>& progress_;
  std::int64_t done_ = 0;
  std::mutex progress_mutex_;

  KernelOptions kernel_;
  std::vector<std::unique_ptr<Worker>> workers_;
  SampleModel model_;
  RefineResult result_;
  enum Origin : unsigned char { kConverged = 1, kOtherStart = 2, kNeighbour = 4, kUnseen = 8 };
  std::vector<unsigned char> origin_;
  // Sums by piece, added up in the pieces' order.
  std::vector<double> start_costs_;
  std::vector<double> sums_;  // cost, then log differences and their number by view
};

Refiner::Refiner(const RefineProblem& problem, const SvbrdfMaps& start,
                 const RefineOptions& options, int threads,
                 const std::function<void(std::int64_t, std::int64_t)>& progress)
    : order_(CanonicalOrder(problem.views)),
      all_views_(problem.views.size()),
      problem_(InOrder(problem, order_)),
      start_(start),
      options_(options),
      threads_(std::max(threads, 1)),
      progress_(progress),
      model_(problem_, start, options) {
  std::iota(all_views_.begin(), all_views_.end(), 0);
  double distance_mm = 0;
  for (const RefineView& view : problem_.views) {
    said_.push_back(view.view);
    const Vec3d& light = view.view.light_in_sample_mm;
    distance_mm +=
        std::hypot(light[0], light[1], light[2]) / static_cast<double>(all_views_.size());
  }
  result_.summary.shared_light.distance_mm = distance_mm;
  kernel_.diffuse_weight = problem.convention.diffuse_weight;
  kernel_.robust_scale = options.robust_scale;
  for (int i = 0; i < threads_; ++i) {
    workers_.push_back(
        std::make_unique<Worker>(kernel_, options, static_cast<int>(problem.views.size())));
  }
  result_.maps = start;
  result_.confidence.assign(start.texels() * kConfidencePlanes, 0.0f);
  origin_.assign(start.texels(), 0);
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

void Refiner::EstimateModel() {
  SampleSolver solver;
  solver.solve = [&](size_t texel, const TexelPrior& prior, const TexelValues& from,
                     std::span<const int> views, int worker) {
    Worker& w = *workers_[static_cast<size_t>(worker)];
    GatherObservations(problem_, start_, texel, views, &w.observations);
    SampledTexel sampled;
    sampled.values = from;
    sampled.views = w.observations.views();
    if (sampled.views == 0) return sampled;
    sampled.values = w.search.FromStart(w.observations, prior, from).solution.values;
    TexelGram& gram = sampled.gram;
    if (!nudged_.empty()) sampled.of_views = OfViews(texel, sampled.values, views, &w);
    w.search.solver().Gram(w.observations, TexelPrior(), sampled.values, &gram);
    sampled.squares = gram[kTexelParameters][kTexelParameters];
    for (int i = 0; i < kTexelParameters; ++i) sampled.prior_diagonal[i] = -gram[i][i];
    prior.AddTo(sampled.values, &gram);
    for (int i = 0; i < kTexelParameters; ++i) sampled.prior_diagonal[i] += gram[i][i];
    return sampled;
  };
  solver.predict = [&](size_t texel, const TexelValues& values, std::span<const int> views,
                       int worker) {
    Worker& w = *workers_[static_cast<size_t>(worker)];
    GatherObservations(problem_, start_, texel, views, &w.observations);
    if (w.observations.views() == 0) return Prediction{};
    return Prediction{2 * w.search.solver().Cost(w.observations, TexelPrior(), values),
                      3 * w.observations.views()};
  };
  solver.deviate = [&](const ViewDeviations& deviations) { SetViews(deviations); };
  if (model_.deviations().any()) nudged_.assign(kViewDeviations, problem_);
  SetViews(model_.deviations());
  model_.Estimate(solver, threads_);
  for (auto& worker : workers_) worker->search.SetNoise(std::sqrt(model_.residuals().variance()));
  model_.Describe(&result_.summary);
}

// To the shared light as it is known, and single views' deviations beside it.
void Refiner::SetViews(const ViewDeviations& deviations) {
  SharedLight& shared = result_.summary.shared_light;
  shared.values = deviations.shared();
  const auto set = [&](size_t v, const DeviationValues& deviation, RefineProblem* problem) {
    problem->views[v].view = Deviating(WithSharedLight(said_[v], shared), deviation);
  };
  for (size_t v = 0; v < said_.size(); ++v) {
    set(v, deviations.values()[v], &problem_);
    for (size_t i = 0; i < nudged_.size(); ++i) {
      DeviationValues further = deviations.values()[v];
      further[i] += kDeviationStep;
      set(v, further, &nudged_[i]);
    }
  }
}

// Leaves the texel's own observations in `worker`.
std::vector<DeviationProducts> Refiner::OfViews(size_t texel, const TexelValues& values,
                                                std::span<const int> views, Worker* worker) {
  TexelSolver& solver = worker->search.solver();
  std::vector<int> usable;
  for (const int v : views) {
    if (problem_.views[static_cast<size_t>(v)].mask[texel] >= 0.5f) usable.push_back(v);
  }
  for (size_t i = 0; i < nudged_.size(); ++i) {
    GatherObservations(nudged_[i], start_, texel, views, &worker->observations);
    solver.Cost(worker->observations, TexelPrior(), values);
    std::vector<double>& residuals = worker->nudged[i];
    residuals.clear();
    for (int c = 0; c < 3; ++c) {
      const double* row = solver.rows().row(c, KernelRows::kResidual);
      residuals.insert(residuals.end(), row, row + usable.size());
    }
  }
  GatherObservations(problem_, start_, texel, views, &worker->observations);
  TexelGram gram;
  solver.Gram(worker->observations, TexelPrior(), values, &gram);
  std::vector<DeviationProducts> products =
      ProductsOf(solver.rows(), worker->nudged, usable.size());
  const SamplePlane& plane = problem_.plane;
  const double x_mm = plane.x_mm(static_cast<int>(texel) % plane.width);
  const double y_mm = plane.y_mm(static_cast<int>(texel) / plane.width);
  for (size_t i = 0; i < usable.size(); ++i) {
    products[i].view = usable[i];
    products[i].by_shared = ByShared(problem_.views[static_cast<size_t>(usable[i])].view,
                                     result_.summary.shared_light.distance_mm, x_mm, y_mm);
  }
  return products;
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
    GatherObservations(problem_, start_, texel, all_views_, &worker->observations);
    if (worker->observations.views() == 0) {
      origin_[texel] = kConverged | kUnseen;  // the initial values stay
      return;
    }
    const TexelValues start = ReadTexel(start_, texel);
    const TexelPrior prior = model_.PriorOf(texel);
    const TexelSearch::Found found = worker->search.FromStart(worker->observations, prior, start);
    start_costs_[texel / kTexelsPerPiece] += found.start_cost;
    if (found.other_start) origin_[texel] |= kOtherStart;
    Keep(texel, found.solution);
  });
}

// One colour of the checkerboard: the neighbours of a texel all have the other, and stand still.
// Half passes count from 1.
void Refiner::SolveFromNeighbours(int half_pass) {
  const int width = start_.width, height = start_.height;
  ForEachTexel([&](size_t texel, Worker* worker) {
    const int column = static_cast<int>(texel % width);
    const int row = static_cast<int>(texel / width);
    if ((row + column + half_pass) % 2 != 0 || (origin_[texel] & kUnseen)) return;
    std::array<TexelValues, 4> neighbours;
    size_t count = 0;
    const auto add = [&](int r, int c) {
      if (r < 0 || r >= height || c < 0 || c >= width) return;
      neighbours[count++] = ReadTexel(result_.maps, static_cast<size_t>(r) * width + c);
    };
    add(row - 1, column);
    add(row, column - 1);
    add(row, column + 1);
    add(row + 1, column);
    GatherObservations(problem_, start_, texel, all_views_, &worker->observations);
    const TexelPrior prior = PriorOf(texel);
    // The prior is no longer the one it was solved with.
    const TexelSolution current =
        worker->search.Improved(worker->observations, prior, Current(texel, prior, worker));
    const TexelSearch::Found found = worker->search.FromNeighbours(
        worker->observations, prior, current, std::span(neighbours).first(count));
    if (found.other_start) origin_[texel] |= kNeighbour;
    Keep(texel, found.solution);
  });
}

// Confidence and the texel's share of the summary, from the observations that `worker` holds.
void Refiner::ConcludeTexel(size_t texel, Worker* worker) {
  const size_t texels = start_.texels();
  const size_t views = problem_.views.size();
  const TexelValues values = ReadTexel(result_.maps, texel);
  const TexelPrior prior = PriorOf(texel);
  TexelGram gram;
  worker->search.solver().Gram(worker->observations, TexelPrior(), values, &gram);
  const double squares = gram[kTexelParameters][kTexelParameters];
  prior.AddTo(values, &gram);
  const auto planes = TexelConfidence(gram, values, squares, model_.residuals().scale());
  for (int p = 0; p < kConfidencePlanes; ++p) result_.confidence[p * texels + texel] = planes[p];

  double* sum = &sums_[texel / kTexelsPerPiece * SumColumns()];
  sum[0] += 0.5 * gram[kTexelParameters][kTexelParameters];
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
    GatherObservations(problem_, start_, texel, all_views_, &worker->observations);
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
  summary.light_offsets_mm.assign(views, {});
  summary.exposures.assign(views, 1.0);
  for (size_t v = 0; v < views && model_.deviations().any(); ++v) {
    const View flashed = WithSharedLight(said_[v], summary.shared_light);
    const View& found = problem_.views[v].view;
    for (size_t i = 0; i < 3; ++i) {
      summary.light_offsets_mm[static_cast<size_t>(order_[v])][i] =
          found.light_in_sample_mm[i] - flashed.light_in_sample_mm[i];
    }
    summary.exposures[static_cast<size_t>(order_[v])] = found.exposure / flashed.exposure;
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
  EstimateModel();
  SolveFromStarts();
  for (int half = 1; half <= 2 * options_.neighbour_passes; ++half) SolveFromNeighbours(half);
  Conclude();
  return std::move(result_);
}

}  // namespace

std::string RefineOptions::Check() const {
  if (iterations < 1) return "iterations must be at least 1";
  if (starts < 1) return "starts must be at least 1";
  if (substances < 1 || substances > kMostSubstances) return "substances must be from 1 to 8";
  if (estimation_rounds < 0) return "estimation rounds must be at least 0";
  if (neighbour_passes < 0) return "neighbour passes must be at least 0";
  if (!(flash_offset >= 0.0)) return "the expected flash offset must be at least 0";
  if (!(flash_beam >= 0.0)) return "the expected gradient of the flash's beam must be at least 0";
  if (!(distance_power >= 0.0)) return "the expected power of distance must be at least 0";
  if (!(exposure_spread >= 0.0)) return "the expected exposure spread must be at least 0";
  if (!(light_spread >= 0.0)) return "the expected light spread must be at least 0";
  if (!(prior >= 0.0)) return "the prior's weight must be at least 0";
  if (!(robust_scale > 0.0)) return "the robust scale must be above 0";
  return "";
}

std::string RefineSummary::BriefReport() const {
  std::ostringstream text;
  text.precision(3);
  text << "cost " << start_cost << " -> " << final_cost << " per texel, residuals "
       << 100 * residual_sigma << " % (model discrepancy " << 100 * discrepancy << " %), "
       << effective_views << " effective views, " << substances << " substances (roughness spread "
       << roughness_spread << "), normals scatter " << normal_spread * 180 / M_PI << " deg, ";
  if (exposure_spread > 0) text << "exposures scatter " << 100 * exposure_spread << " %, ";
  text << 100.0 * converged << " % converged";
  return text.str();
}

RefineResult Refine(const RefineProblem& problem, const SvbrdfMaps& start,
                    const RefineOptions& options, int threads,
                    const std::function<void(std::int64_t, std::int64_t)>& progress) {
  const std::string wrong = options.Check();
  if (!wrong.empty()) throw std::invalid_argument("refine: " + wrong);
  CheckProblem(problem, start);
  return Refiner(problem, start, options, threads, progress).Run();
}

}  // namespace glint
