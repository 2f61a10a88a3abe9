#include "fitting/refine/estimate_sample.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "base/model/solver.h"
#include "fitting/refine/gather.h"
#include "fitting/refine/refine_worker.h"
#include "fitting/refine/view_sharpness.h"
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

using Matrix9 = Eigen::Matrix<double, kTexelParameters, kTexelParameters>;

// By Cholesky's factor and its inverse; Eigen's solver takes five times as long for so few.
Matrix9 InverseOfPositive(const Matrix9& matrix) {
  const Eigen::LLT<Matrix9> cholesky(matrix);
  if (cholesky.info() != Eigen::Success) return matrix.ldlt().solve(Matrix9::Identity());
  const Matrix9& factor = cholesky.matrixLLT();  // its lower triangle
  Matrix9 inverse = Matrix9::Zero();             // of the factor
  for (int j = 0; j < kTexelParameters; ++j) {
    inverse(j, j) = 1 / factor(j, j);
    for (int i = j + 1; i < kTexelParameters; ++i) {
      double sum = 0;
      for (int k = j; k < i; ++k) sum += factor(i, k) * inverse(k, j);
      inverse(i, j) = -sum / factor(i, i);
    }
  }
  return inverse.transpose().lazyProduct(inverse);
}

// In double precision: what a substance's mean is known by is small differences of it
// (UpdateMeans()).
Matrix9 InverseOf(const TexelGram& gram) {
  Matrix9 information;
  for (int i = 0; i < kTexelParameters; ++i) {
    for (int j = i; j < kTexelParameters; ++j) {
      information(i, j) = information(j, i) = gram[static_cast<size_t>(i)][static_cast<size_t>(j)];
    }
    information(i, i) += constants::kUnknownInformation;
  }
  return InverseOfPositive(information);
}

// Of the photographs alone.
BatchGram GramOf(const BatchObservations& observed, std::span<const TexelValues> values,
                 RefineWorker* worker, BatchResiduals* residuals = nullptr) {
  BatchValues batch;
  for (size_t i = 0; i < values.size(); ++i) SetLane(static_cast<int>(i), values[i], &batch);
  BatchGram gram;
  worker->batches.evaluator().Gram(observed, batch, &gram, residuals);
  return gram;
}

// `weights`: by view observed.
ViewDifferences DifferencesOf(const BatchResiduals& residuals, const BatchObservations& observed,
                              std::span<const double> weights, int lane) {
  ViewDifferences differences;
  for (int view = 0; view < observed.views(); ++view) {
    std::optional<std::array<float, 3>>& of = differences.emplace_back();
    if (!observed.sees(view, lane)) continue;
    of.emplace();
    const double unit = std::sqrt(weights[static_cast<size_t>(view)]);
    for (int c = 0; c < 3; ++c) {
      (*of)[static_cast<size_t>(c)] =
          static_cast<float>(unit * residuals.at(view, c, BatchResiduals::kDifference, lane));
    }
  }
  return differences;
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
        gathered_(problem_, start),
        look_(problem_, threads),
        looks_(LooksOf(problem_, start, look_, true, threads)),
        by_gloss_(problem_, start, {look_, Substances(looks_, options.substances, true)}, looks_,
                  threads),
        model_(by_gloss_, options) {
    if (look_.tells()) {
      by_colour_.emplace(problem_, start,
                         SampleSubstances{look_, Substances(looks_, options.substances, false)},
                         looks_, threads);
    }
    shared_light_.distance_mm = MeanLightDistance_mm(said_);
  }
  void Run();
  SampleEstimate Estimate(std::vector<int> order) const;

 private:
  void SetViews(const ViewDeviations& deviations);
  void Weigh(double residual_variance);
  void Solve(std::span<const SampleTask> tasks, const SampleRequest& request, RefineWorker* worker,
             std::span<SampledTexel> solved);
  void Describe(std::span<const SampleTask> tasks, const SampleRequest& request,
                RefineWorker* worker, std::span<SampledTexel> solved);
  std::vector<DeviationProducts> OfViews(size_t texel, int lane, std::span<const int> views,
                                         const BatchObservations& observed,
                                         const RefineWorker& worker) const;

  RefineProblem problem_;         // views as they deviate
  double weighed_variance_ = 0;   // of residuals, by which they are weighed
  const std::vector<View> said_;  // those, with lights where they are said to be
  // The problem with one deviation of every view a step further, where they are looked for.
  std::vector<RefineProblem> nudged_;
  UnknownDeviations unknown_{};
  const SvbrdfMaps& start_;
  const int threads_;
  std::vector<std::unique_ptr<RefineWorker>> workers_;
  GatheredObservations gathered_;
  const SampleLook look_;
  const TexelLooks looks_;
  const SamplePart by_gloss_;
  std::optional<SamplePart> by_colour_;  // none: gloss tells nothing apart
  SampleModel model_;
  SharedLight shared_light_;
};

void Estimator::Run() {
  SampleSolver solver;
  solver.solve = [&](std::span<const SampleTask> tasks, const SampleRequest& request, int worker,
                     std::span<SampledTexel> solved) {
    RefineWorker* w = workers_[static_cast<size_t>(worker)].get();
    Solve(tasks, request, w, solved);
    for (size_t first = 0; !request.values_alone && first < tasks.size(); first += kBatch) {
      const size_t count = std::min<size_t>(kBatch, tasks.size() - first);
      Describe(tasks.subspan(first, count), request, w, solved.subspan(first, count));
    }
  };
  solver.predict = [&](std::span<const size_t> texels, std::span<const TexelValues> values,
                       std::span<const int> views, int worker,
                       std::span<ViewDifferences> differences) {
    RefineWorker* w = workers_[static_cast<size_t>(worker)].get();
    std::vector<double> weights;
    for (const int v : views) weights.push_back(problem_.views[static_cast<size_t>(v)].weight);
    for (size_t first = 0; first < texels.size(); first += kBatch) {
      const size_t count = std::min<size_t>(kBatch, texels.size() - first);
      const BatchObservations& observed =
          gathered_.Of(texels.subspan(first, count), views, &w->observed);
      GramOf(observed, values.subspan(first, count), w, &w->residuals);
      for (size_t i = 0; i < count; ++i) {
        differences[first + i] =
            DifferencesOf(w->residuals, observed, weights, static_cast<int>(i));
      }
    }
  };
  solver.deviate = [&](const ViewDeviations& deviations) { SetViews(deviations); };
  solver.weigh = [&](double variance) { Weigh(variance); };
  solver.reflect = [&](const SpecularLobes& lobes) {
    for (const auto& worker : workers_) worker->batches.SetLobes(lobes);
  };
  if (model_.deviations().any()) nudged_.assign(kViewDeviations, problem_);
  SetViews(model_.deviations());
  Weigh(model_.residuals().variance());
  model_.Estimate(by_colour_ ? &*by_colour_ : nullptr, solver, threads_);
}

void Estimator::Solve(std::span<const SampleTask> tasks, const SampleRequest& request,
                      RefineWorker* worker, std::span<SampledTexel> solved) {
  using From = BatchSearch::From;
  BatchSearch& batches = worker->batches;
  batches.SetExplained(request.explained_sigma);
  batches.Begin(
      request.near_minimum ? From::kNearMinimum : From::kStart,
      [&](std::span<const size_t> ids, BatchObservations* buffer) {
        std::array<size_t, kBatch> texels;
        for (size_t i = 0; i < ids.size(); ++i) texels[i] = tasks[ids[i]].texel;
        return &gathered_.Of(std::span(texels).first(ids.size()), request.views, buffer);
      },
      [&](const BatchSearch::Task& task, const BatchSearch::Found& found) {
        solved[task.id].values = found.solution.values;
      });
  for (size_t i = 0; i < tasks.size(); ++i) {
    batches.Add({.id = i, .prior = tasks[i].prior, .start = tasks[i].from, .converged = true});
  }
  batches.Finish();
}

// At most a batch of texels at their solutions.
void Estimator::Describe(std::span<const SampleTask> tasks, const SampleRequest& request,
                         RefineWorker* worker, std::span<SampledTexel> solved) {
  std::vector<size_t> texels;
  std::vector<TexelValues> values;
  for (size_t i = 0; i < tasks.size(); ++i) {
    texels.push_back(tasks[i].texel);
    values.push_back(solved[i].values);
  }
  const bool of_views = request.of_views && std::any_of(unknown_.begin(), unknown_.end(),
                                                        [](bool unknown) { return unknown; });
  for (size_t i = 0; of_views && i < nudged_.size(); ++i) {
    if (!unknown_[i] || IsOfCurve(i)) continue;
    GatherObservations(nudged_[i], start_, texels, request.views, &worker->observed);
    GramOf(worker->observed, values, worker, &worker->nudged[i]);
  }
  const BatchObservations& observed = gathered_.Of(texels, request.views, &worker->observed);
  for (size_t i = kToe; of_views && i < nudged_.size(); ++i) {
    if (!unknown_[i]) continue;
    worker->batches.SetCurve(CurveOf(nudged_[i]));
    GramOf(observed, values, worker, &worker->nudged[i]);
    worker->batches.SetCurve(CurveOf(problem_));
  }
  GramOf(observed, values, worker, &worker->residuals);
  for (size_t i = 0; i < tasks.size(); ++i) {
    const int lane = static_cast<int>(i);
    SampledTexel& sampled = solved[i];
    sampled.views = observed.seen(lane);
    sampled.of_views = {};
    if (sampled.views == 0) continue;
    if (of_views) sampled.of_views = OfViews(texels[i], lane, request.views, observed, *worker);
    TexelGram gram = worker->residuals.GramOf(lane, observed.views()), prior{};
    sampled.squares = gram[kTexelParameters][kTexelParameters];
    tasks[i].prior.AddTo(sampled.values, &gram);
    Eigen::Map<Matrix9>(sampled.inverse.data()) = InverseOf(gram);
    tasks[i].prior.AddTo(sampled.values, &prior);
    for (size_t k = 0; k < kTexelParameters; ++k) sampled.prior_diagonal[k] = prior[k][k];
  }
}

// To the shared light as it is known, and single views' deviations beside it.
void Estimator::SetViews(const ViewDeviations& deviations) {
  unknown_ = deviations.unknown();
  shared_light_.values = deviations.shared();
  const auto set = [&](size_t v, const DeviationValues& deviation, RefineProblem* problem) {
    problem->views[v].view = Deviating(WithSharedLight(said_[v], shared_light_), deviation);
  };
  for (size_t v = 0; v < said_.size(); ++v) {
    set(v, deviations.values()[v], &problem_);
    for (size_t i = 0; i < nudged_.size(); ++i) {
      DeviationValues further = deviations.values()[v];
      further[i] += constants::kDeviationStep;
      set(v, further, &nudged_[i]);
    }
  }
  for (const auto& worker : workers_) worker->batches.SetCurve(CurveOf(problem_));
  gathered_.Forget();
}

void Estimator::Weigh(double residual_variance) {
  const bool alike = std::all_of(problem_.views.begin(), problem_.views.end(),
                                 [](const RefineView& view) { return view.hidden_variance == 0; });
  if (alike || residual_variance == weighed_variance_) return;
  weighed_variance_ = residual_variance;
  WeighViews(residual_variance, &problem_);
  for (RefineProblem& nudged : nudged_) WeighViews(residual_variance, &nudged);
  gathered_.Forget();
}

// Of one lane's texel.
std::vector<DeviationProducts> Estimator::OfViews(size_t texel, int lane,
                                                  std::span<const int> views,
                                                  const BatchObservations& observed,
                                                  const RefineWorker& worker) const {
  const SamplePlane& plane = problem_.plane;
  const double x_mm = plane.x_mm(static_cast<int>(texel) % plane.width);
  const double y_mm = plane.y_mm(static_cast<int>(texel) / plane.width);
  std::vector<DeviationProducts> products;
  for (size_t k = 0; k < views.size(); ++k) {
    const int view = static_cast<int>(k);
    if (!observed.sees(view, lane)) continue;
    DeviationProducts& of =
        products.emplace_back(ProductsOf(worker.residuals, worker.nudged, unknown_, view, lane));
    of.view = views[k];
    const SharedLightValues by = DeviationsByShared(
        problem_.views[static_cast<size_t>(views[k])].view, shared_light_.distance_mm, x_mm, y_mm);
    std::copy(by.begin(), by.end(), of.by_shared.begin());
  }
  return products;
}

SampleEstimate Estimator::Estimate(std::vector<int> order) const {
  SampleEstimate estimate{std::move(order),      said_,  ViewsOf(problem_),
                          model_.part().known(), model_, {}};
  RefineSummary& summary = estimate.summary;
  model_.Describe(&summary);
  summary.shared_light = shared_light_;
  summary.curve = CurveOf(problem_);
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
  problem.convention.lobes = model.lobes();
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
