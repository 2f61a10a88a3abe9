// Solves the texels of some rows of a sample. The loop over texels, in which a version for another
// processor would take rows at a time, is in the .cc file.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "fitting/refine/estimate_sample.h"
#include "fitting/refine/refine.h"
#include "fitting/refine/refine_worker.h"
#include "fitting/relief/relief_slopes.h"

namespace glint {

// Rows above and below that steps depend on where the sample goes on: all photographs (a
// Deblurred() looks as far, point_spread.h), and solved texels besides.
int RowsAboutStarts(const RefineProblem& problem, const RefineOptions& options);
int RowsAboutPass(const RefineProblem& problem, const RefineOptions& options);
int RowsAboutConclusion(const RefineProblem& problem, const RefineOptions& options);

// Texels of some rows between steps.
struct SolvedTexels {
  SvbrdfMaps maps;
  std::vector<unsigned char> origin;  // PartRefiner's
};

class PartRefiner {
 public:
  // `said`: views in the estimate's order, as they are said to be; the first `above` and the last
  // `below` rows are there for the others' sake. `count`: called by rows done. The problem and
  // `start` must outlive this.
  PartRefiner(const SampleEstimate& estimate, const RefineProblem& said, const SvbrdfMaps& start,
              const RefineOptions& options, int above, int below, int threads,
              std::function<void(int row)> count);

  // Steps give the rows asked for; the others are not to be used. Each texel by itself, from the
  // initial maps:
  SolvedTexels SolveFromStarts();
  // By row, of SolveFromStarts(): the sum of costs at the start.
  std::vector<double> start_costs() const;
  // By what neighbours are, and by slopes of the sample's relief (n_x/n_z, n_y/n_z; empty: not
  // known), of all rows:
  SolvedTexels Pass(SolvedTexels solved, std::array<std::vector<float>, 2> relief);

  struct Result {
    SvbrdfMaps maps;
    std::vector<float> confidence;  // kConfidencePlanes planes of H·W
  };
  // After the last pass, with its relief.
  Result Conclude(SolvedTexels solved, std::array<std::vector<float>, 2> relief);
  // What is summed over the row's texels, after Conclude(): how many converged, came from another
  // start, from a neighbour; the cost; log differences by view, and their number by view.
  std::vector<double> SumsOf(int row) const;

 private:
  enum Origin : unsigned char { kConverged = 1, kOtherStart = 2, kNeighbour = 4, kUnseen = 8 };
  // Of the row's texels, how many have the flag.
  double Count(int row, Origin flag) const;
  size_t SumColumns() const { return 1 + 2 * problem_.views.size(); }
  void Deblur();
  // One colour of the checkerboard, of the rows asked for and of so many about them.
  void SolveHalf(int half, int about);
  BatchSearch::Task FromNeighbours(size_t texel) const;
  void ConcludeBatch(std::span<const size_t> texels, RefineWorker* worker);
  void ConcludeTexel(size_t texel, int lane, const BatchGram& photographs,
                     const BatchInverse& inverse, const RefineWorker& worker);
  // Of the rows asked for and of so many about them, a few at a time.
  void ForEachRows(int about,
                   const std::function<void(int begin, int end, RefineWorker* worker)>& visit);
  const BatchObservations* Gather(std::span<const size_t> texels,
                                  BatchObservations* observations) const;
  TexelPrior PriorOf(size_t texel) const;
  void Keep(size_t texel, const TexelSolution& solution);

  std::vector<int> all_views_;
  const SamplePart part_;
  const SampleModel model_;
  RefineProblem problem_;  // views with their deviations
  const int blurred_rows_;
  std::vector<std::vector<float>> deblurred_;  // by view; empty: it has no blur
  const SvbrdfMaps& start_;
  const RefineOptions& options_;
  const int threads_;
  const int first_row_;      // in the whole sample
  const int above_, below_;  // rows that were not asked for
  const std::function<void(int row)> count_;
  std::vector<std::unique_ptr<RefineWorker>> workers_;
  SolvedTexels now_;
  std::array<std::vector<float>, 2> relief_;
  std::vector<float> confidence_;
  std::vector<float> start_costs_;
  std::vector<double> sums_;  // by row: cost, log differences and their number by view
};

}  // namespace glint
