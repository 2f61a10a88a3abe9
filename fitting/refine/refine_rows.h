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

// Rows above and below that rows of `problem` depend on: each half pass looks at neighbours, and so
// does the prior in the end; where photographs are blurred, each pass looks as far as the blur
// reaches, there and back (point_spread.h).
int DependentRows(const RefineProblem& problem, const RefineOptions& options);

// What is added up over texels, a list a row, so that sums over any parts of the sample are to the
// bit those over the whole: the cost at the start; how many texels converged, came from another
// start, from a neighbour; the cost; log differences by view, and their number by view.
using RowSums = std::vector<std::vector<double>>;
inline size_t RowSumColumns(size_t views) { return 5 + 2 * views; }

// What RefineSummary says of texels and views. `rows`: all of the sample, from the top.
RefineSummary Summarise(const SampleEstimate& estimate, const RowSums& rows, int width);

class RowRefiner {
 public:
  using ReportProgress = std::function<void(std::int64_t done, std::int64_t total)>;

  // `estimate` and `options` must outlive this. `rows`: how many it will be given in all.
  RowRefiner(const SampleEstimate& estimate, const RefineOptions& options, int rows, int threads,
             ReportProgress progress);

  struct Rows {
    SvbrdfMaps maps;
    std::vector<float> confidence;  // kConfidencePlanes planes of H·W
  };
  // Of `problem`, views as they are said to be, all but its first `above` and last `below` rows:
  // DependentRows() where the sample goes on, 0 at its border. From the top, each row once.
  Rows Refine(const RefineProblem& problem, const SvbrdfMaps& start, int above, int below);

  // Of the rows so far.
  const RowSums& sums() const { return sums_; }

 private:
  const SampleEstimate& estimate_;
  const RefineOptions& options_;
  const int rows_, threads_;
  const ReportProgress progress_;
  std::int64_t done_ = 0;
  RowSums sums_;
};

}  // namespace glint
