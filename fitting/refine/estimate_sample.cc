#include "fitting/refine/estimate_sample.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "fitting/refine/gather.h"
#include "fitting/refine/refine_worker.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

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

RefineProblem Reordered(RefineProblem problem, const std::vector<int>& order) {
  const std::vector<RefineView> views = problem.views;
  for (size_t i = 0; i < order.size(); ++i) {
    problem.views[i] = views[static_cast<size_t>(order[i])];
  }
  return problem;
}

std::vector<View> ViewsOf(const RefineProblem& problem) {
  std::vector<View> views;
  for (const RefineView& view : problem.views) views.push_back(view.view);
  return views;
}

// Solves sampled texels for the model, with views as the model says.
class Estimator {
 public:
  // `problem`: views in canonical order.
  Estimator(const RefineProblem& problem, const SvbrdfMaps& start, const RefineOptions& options,
            int threads)
      : problem_(problem),
        said_(ViewsOf(problem)),
        start_(start),
        threads_(threads),
        workers_(RefineWorkers(problem, options, threads)),
        part_(problem_, start, std::nullopt, options.substances),
        model_(part_, options) {
    shared_light_.distance_mm = MeanLightDistance_mm(said_);
  }
  void Run();
  SampleEstimate Estimate(std::vector<int> order) const;

 private:
  void SetViews(const ViewDeviations& deviations);
  std::vector<DeviationProducts> OfViews(size_t texel, const TexelValues& values,
                                         std::span<const int> views, RefineWorker* worker);

  RefineProblem problem_;         // views as they deviate
  const std::vector<View> said_;  // those, with lights where they are said to be
  // The problem with one deviation of every view a step further, where they are looked for.
  std::vector<RefineProblem> nudged_;
  const SvbrdfMaps& start_;
  const int threads_;
  std::vector<std::unique_ptr<RefineWorker>> workers_;
  const SamplePart part_;
  SampleModel model_;
  SharedLight shared_light_;
};

void Estimator::Run() {
  SampleSolver solver;
  solver.solve = [&](size_t texel, const TexelPrior& prior, const TexelValues& from,
                     const SampleRequest& request, int worker) {
    RefineWorker& w = *workers_[static_cast<size_t>(worker)];
    GatherObservations(problem_, start_, texel, request.views, &w.observations);
    SampledTexel sampled;
    sampled.values = from;
    sampled.views = w.observations.views();
    if (sampled.views == 0) return sampled;
    w.search.SetExplained(request.explained_sigma);
    sampled.values = request.near_minimum
                         ? w.search.Improved(w.observations, prior, from, true).values
                         : w.search.FromStart(w.observations, prior, from).solution.values;
    TexelGram& gram = sampled.gram;
    if (request.of_views && !nudged_.empty()) {
      sampled.of_views = OfViews(texel, sampled.values, request.views, &w);
    }
    w.search.solver().Gram(w.observations, TexelPrior(), sampled.values, &gram);
    sampled.squares = gram[kTexelParameters][kTexelParameters];
    for (int i = 0; i < kTexelParameters; ++i) sampled.prior_diagonal[i] = -gram[i][i];
    prior.AddTo(sampled.values, &gram);
    for (int i = 0; i < kTexelParameters; ++i) sampled.prior_diagonal[i] += gram[i][i];
    return sampled;
  };
  solver.predict = [&](size_t texel, const TexelValues& values, std::span<const int> views,
                       int worker) {
    RefineWorker& w = *workers_[static_cast<size_t>(worker)];
    GatherObservations(problem_, start_, texel, views, &w.observations);
    if (w.observations.views() == 0) return Prediction{};
    return Prediction{2 * w.search.solver().Cost(w.observations, TexelPrior(), values),
                      3 * w.observations.views()};
  };
  solver.deviate = [&](const ViewDeviations& deviations) { SetViews(deviations); };
  if (model_.deviations().any()) nudged_.assign(kViewDeviations, problem_);
  SetViews(model_.deviations());
  model_.Estimate(solver, threads_);
}

// To the shared light as it is known, and single views' deviations beside it.
void Estimator::SetViews(const ViewDeviations& deviations) {
  shared_light_.values = deviations.shared();
  const auto set = [&](size_t v, const DeviationValues& deviation, RefineProblem* problem) {
    problem->views[v].view = Deviating(WithSharedLight(said_[v], shared_light_), deviation);
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
std::vector<DeviationProducts> Estimator::OfViews(size_t texel, const TexelValues& values,
                                                  std::span<const int> views,
                                                  RefineWorker* worker) {
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
                                     shared_light_.distance_mm, x_mm, y_mm);
  }
  return products;
}

SampleEstimate Estimator::Estimate(std::vector<int> order) const {
  SampleEstimate estimate{std::move(order),   said_,  ViewsOf(problem_),
                          part_.substances(), model_, {}};
  RefineSummary& summary = estimate.summary;
  model_.Describe(&summary);
  summary.shared_light = shared_light_;
  const size_t views = said_.size();
  summary.light_offsets_mm.assign(views, {});
  summary.exposures.assign(views, 1.0);
  for (size_t v = 0; v < views && model_.deviations().any(); ++v) {
    const auto place = static_cast<size_t>(estimate.order[v]);
    const View flashed = WithSharedLight(said_[v], shared_light_);
    const View& found = estimate.found[v];
    for (size_t i = 0; i < 3; ++i) {
      summary.light_offsets_mm[place][i] =
          found.light_in_sample_mm[i] - flashed.light_in_sample_mm[i];
    }
    summary.exposures[place] = found.exposure / flashed.exposure;
  }
  return estimate;
}

}  // namespace

RefineProblem SampleEstimate::InOrder(RefineProblem problem) const {
  return Reordered(std::move(problem), order);
}

SampleEstimate EstimateSample(const RefineProblem& problem, const SvbrdfMaps& start,
                              const RefineOptions& options, int threads) {
  std::vector<int> order = CanonicalOrder(problem.views);
  Estimator estimator(Reordered(problem, order), start, options, threads);
  estimator.Run();
  return estimator.Estimate(std::move(order));
}

int EstimationStride(const SamplePlane& plane, int size) {
  int stride = 1;
  while (std::max(plane.width, plane.height) > stride * size) stride += 2;
  return stride;
}

}  // namespace glint
