// What one thread of refinement owns.
#pragma once

#include <memory>
#include <vector>

#include "fitting/refine/refine.h"
#include "fitting/refine/view_deviations.h"
#include "fitting/texel/texel_observations.h"
#include "fitting/texel/texel_search.h"

namespace glint {

struct RefineWorker {
  RefineWorker(const KernelOptions& options, const RefineOptions& refine, int views)
      : observations(views),
        search(options, refine.iterations, views, refine.starts),
        differences(3 * static_cast<size_t>(views)),
        nudged(kViewDeviations) {}
  TexelObservations observations;
  TexelSearch search;
  std::vector<double> differences;
  std::vector<std::vector<double>> nudged;  // residuals, views a step further off
};

inline KernelOptions KernelOptionsOf(const RefineProblem& problem, const RefineOptions& options) {
  KernelOptions kernel;
  kernel.diffuse_weight = problem.convention.diffuse_weight;
  kernel.robust_scale = options.robust_scale;
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
