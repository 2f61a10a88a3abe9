// What one thread of refinement owns.
#pragma once

#include <memory>
#include <vector>

#include "fitting/refine/refine.h"
#include "fitting/refine/view_deviations.h"
#include "fitting/texel/batch_search.h"

namespace glint {

struct RefineWorker {
  RefineWorker(const KernelOptions& options, const RefineOptions& refine, int views)
      : observed(views),
        batches(options, refine.iterations, views, refine.starts),
        residuals(views) {
    for (int i = 0; i < kViewDeviations; ++i) nudged.emplace_back(views);
  }
  BatchObservations observed;
  BatchSearch batches;
  BatchResiduals residuals;
  std::vector<BatchResiduals> nudged;  // views a step further off, by deviation
};

// All photographs of a capture have one curve.
inline CharacteristicCurve CurveOf(const RefineProblem& problem) {
  return problem.views.empty() ? CharacteristicCurve() : problem.views[0].view.curve;
}

inline KernelOptions KernelOptionsOf(const RefineProblem& problem, const RefineOptions& options) {
  KernelOptions kernel;
  kernel.diffuse_weight = problem.convention.diffuse_weight;
  kernel.mix = LobeMixOf<float>(problem.convention.lobes);
  kernel.robust_scale = options.robust_scale;
  kernel.curve = CurveOf(problem);
  return kernel;
}

inline std::vector<std::unique_ptr<RefineWorker>> RefineWorkers(const RefineProblem& problem,
                                                                const RefineOptions& options,
                                                                int threads) {
  std::vector<std::unique_ptr<RefineWorker>> workers;
  workers.reserve(static_cast<size_t>(threads));
  for (int i = 0; i < threads; ++i) {
    workers.push_back(std::make_unique<RefineWorker>(KernelOptionsOf(problem, options), options,
                                                     static_cast<int>(problem.views.size())));
  }
  return workers;
}

}  // namespace glint
