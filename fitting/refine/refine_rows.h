// Refinement by rows of the sample, so that a large one is never whole in memory. It goes over the
// sample in steps: texels by themselves, passes in which they look at their neighbours and at the
// relief of all of them, and the conclusion. Rows may be cut anywhere in each.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/files/scratch_rows.h"
#include "fitting/refine/estimate_sample.h"
#include "fitting/refine/part_refiner.h"
#include "fitting/refine/refine.h"
#include "fitting/relief/relief_slopes.h"

namespace glint {

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

  // Of the rows `asked` of a sample with the problem's plane; its views need no pixels. Between
  // steps texels lie in `scratch` (ScratchRows). `estimate` and `options` must outlive this.
  RowRefiner(const SampleEstimate& estimate, const RefineOptions& options,
             const RefineProblem& sample, RowSpan asked, const std::filesystem::path& scratch,
             int threads, ReportProgress progress);

  int steps() const { return options_.neighbour_passes + 2; }
  // To be done in a step: the rows asked for, and those that later steps depend on.
  RowSpan RowsOf(int step) const { return rows_[static_cast<size_t>(step)]; }
  // How many above and below must be given where the sample goes on.
  int RowsAbout(int step) const;

  // Takes rows of the sample in hand, with views as they are said to be; `above` and `below` of
  // them are there for the others: RowsAbout(step), or as many as there are. They must stay where
  // they are until others are taken.
  void Take(const RefineProblem& problem, const SvbrdfMaps& start, int above, int below);
  // A step of the rows in hand: steps in turn, and in each RowsOf(step) from the top, each row
  // once. The last step gives its rows, others nothing.
  using Rows = PartRefiner::Result;
  std::optional<Rows> Do(int step);

  // Of the rows concluded so far.
  const RowSums& sums() const { return sums_; }

 private:
  struct Part {  // rows in hand
    RefineProblem said;
    int first_row, height, above, below;
    std::optional<PartRefiner> refiner;
    RowSpan rows() const { return {first_row, first_row + height}; }
  };
  void Write(int step, const SolvedTexels& solved);
  SolvedTexels Read(int step, RowSpan rows) const;
  std::array<std::vector<float>, 2> SlopesAfter(int step, RowSpan rows) const;
  void FindRelief(int step);
  std::array<std::vector<float>, 2> Relief() const;
  Rows Conclude();

  const SampleEstimate& estimate_;
  const RefineOptions& options_;
  const RefineProblem sample_;
  const int threads_;
  const ReportProgress progress_;
  const bool has_relief_;
  std::vector<RowSpan> rows_;  // by step
  // Texels as an even or an odd step leaves them: maps and flags, rows of the whole sample.
  std::array<ScratchRows, 2> solved_;
  ScratchRows relief_;               // slopes, as the pass at hand takes them
  int relief_of_ = 0;                // that pass; 0: none yet
  std::vector<double> start_costs_;  // by row of the first step
  std::unique_ptr<Part> part_;
  std::int64_t done_ = 0, visits_ = 0;
  RowSums sums_;
};

}  // namespace glint
