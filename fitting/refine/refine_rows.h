// Refinement by rows of the sample, so that a large one is never whole in memory: texels are solved
// as if all of them were there, and rows may be cut anywhere. The loop over texels, in which a
// version for another processor would take rows at a time, is PartRefiner's in the .cc file.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fitting/refine/estimate_sample.h"
#include "fitting/refine/refine.h"

namespace glint {

// Rows above and below that rows depend on: each half pass looks at neighbours, and so does the
// prior in the end.
inline int DependentRows(const RefineOptions& options) { return 2 * options.neighbour_passes + 1; }

class RowRefiner {
 public:
  using ReportProgress = std::function<void(std::int64_t done, std::int64_t total)>;

  // `estimate` and `options` must outlive this.
  RowRefiner(const SampleEstimate& estimate, const RefineOptions& options, int threads,
             ReportProgress progress);

  struct Rows {
    SvbrdfMaps maps;
    std::vector<float> confidence;  // kConfidencePlanes planes of H·W
  };
  // Of `problem`, views as they are said to be, all but its first `above` and last `below` rows:
  // DependentRows() where the sample goes on, 0 at its border. From the top, each row once.
  Rows Refine(const RefineProblem& problem, const SvbrdfMaps& start, int above, int below);

  // After the last row.
  RefineSummary Summary() const;

 private:
  const SampleEstimate& estimate_;
  const RefineOptions& options_;
  const int threads_;
  const ReportProgress progress_;
  std::int64_t done_ = 0;
  // Over the rows so far.
  std::int64_t texels_ = 0, converged_ = 0, other_start_ = 0, neighbour_ = 0;
  double start_cost_ = 0;
  std::vector<double> sums_;  // cost, then log differences and their number by view
};

}  // namespace glint
