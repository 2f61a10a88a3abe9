// More than one start per texel, many texels at once: the local minimum next to the start need not
// be the best. Texels are solved in batches. Those that take longer than half of their vector go on
// in a batch of their own, from which they leave as they end and in which others take their places;
// so do those that their solution leaves unexplained, in a batch in which other starts are tried.
// No texel's result depends on which others it is solved with.
#pragma once

#include <functional>
#include <span>

#include "fitting/texel/batch_kernel.h"

namespace glint {

struct TexelSolution {
  TexelValues values{};
  double start_cost = 0;  // of the start, drawn off its bounds
  double cost = 0;        // half the sum of squared residuals, prior included
  bool converged = false;
};

// Evaluates batches with memory for one thread.
class BatchEvaluator {
 public:
  BatchEvaluator(const KernelOptions& options, int most_views);

  const KernelOptions& options() const { return options_; }
  void SetLobes(const SpecularLobes& lobes);
  void SetCurve(const CharacteristicCurve& curve) { options_.curve = curve; }
  // Of the photographs alone.
  void Gram(const BatchObservations& observations, const BatchValues& values, BatchGram* gram,
            BatchResiduals* residuals = nullptr);
  // See BatchKernel.
  void Inverse(const BatchGram& photographs, const BatchPrior& prior, const BatchValues& values,
               double least, BatchInverse* inverse);
  void Solve(const kernel::SolveOptions& solve, const BatchObservations& observations,
             const BatchPrior& prior, kernel::LaneBits active, kernel::Solving how,
             kernel::BatchSolution* solution);
  void AlbedoSums(const BatchObservations& observations, const BatchValues& values,
                  BatchAlbedoSums* sums);

 private:
  kernel::BatchViews ViewsOf(const BatchObservations& observations);

  KernelOptions options_;
  const kernel::BatchKernel& kernel_;
  std::vector<BatchRow> scratch_;
};

class BatchSearch {
 public:
  // What is tried for each texel.
  enum class From {
    kStart,        // the start; where that leaves it unexplained the prior's mean, up to
                   // `starts − 1` other roughnesses, each with albedos fitted to it, and as many
                   // with the normal that mirrors the light into the view in which the texel is
                   // brightest and with the one whose diffuse shading the views show. Never
                   // costlier than the start, drawn off its bounds.
    kNearMinimum,  // the start, which is next to a minimum
    kNeighbours,   // likewise; where that leaves it unexplained, the neighbour's normal and
                   // roughness, or roughness alone, that promises least
  };
  struct Task {
    size_t id = 0;
    TexelPrior prior;
    TexelValues start{};
    bool converged = false;  // whether the start is, where it is next to a minimum
    std::array<TexelValues, 4> neighbours{};
    int neighbour_count = 0;
  };
  struct Found {
    TexelSolution solution;
    int views = 0;             // that see it; 0: the start stays
    bool other_start = false;  // it did not come from the start itself
  };
  using Done = std::function<void(const Task& task, const Found& found)>;
  // Gives the observations of the tasks with these ids (Task::id), in the lanes from 0 on: in
  // `buffer`, or elsewhere, where they stay until the next call.
  using Gather = std::function<const BatchObservations*(std::span<const size_t> ids,
                                                        BatchObservations* buffer)>;

  BatchSearch(const KernelOptions& options, int most_iterations, int most_views, int starts);

  // Texels whose residuals are no larger are not searched further; 0 to begin with.
  void SetExplained(double residual_sigma) { variance_ = residual_sigma * residual_sigma; }
  // The same, and solves end when they gain a small part of such a residual's square.
  void SetNoise(double residual_sigma);

  void SetLobes(const SpecularLobes& lobes) { evaluator_.SetLobes(lobes); }
  void SetCurve(const CharacteristicCurve& curve) { evaluator_.SetCurve(curve); }

  // From here on tasks are `from`; `done` is called with each in any order, by Finish() at the
  // latest.
  void Begin(From from, Gather gather, Done done);
  void Add(const Task& task);
  void Finish();

  BatchEvaluator& evaluator() { return evaluator_; }

 private:
  struct Batch {
    explicit Batch(int most_views) : buffer(most_views) {}
    Batch(const Batch&) = delete;  // it may point into itself
    Batch& operator=(const Batch&) = delete;
    const BatchObservations& observations() const { return *seen; }

    BatchObservations buffer;
    BatchPrior prior;
    std::array<Task, kBatch> tasks;
    std::array<Found, kBatch> found;
    kernel::BatchSolution solution;
    const BatchObservations* seen = &buffer;
    kernel::LaneBits taken = 0;  // lanes with a task

    bool full() const { return taken == kernel::kAllLanes; }
    int FreeLane() const;
    // A lane of another batch, to the first one that is free here.
    void Take(const Batch& from, int lane);
  };
  struct Candidate {
    TexelValues values{};
    double before = 0, after = 0;  // albedo fits' squares (texel_albedos.h), prior included
  };
  using Candidates = std::array<Candidate, kBatch>;

  bool Unexplained(const Batch& batch, int lane) const;
  void RunFirst();
  void RunSlow(kernel::Solving how);
  void RunSecond();
  // A texel whose solve has ended: done, or to be searched further.
  void Conclude(Batch* batch, int lane);
  void TryPriorMeans();
  void TryOtherStarts();
  void TryNeighbours();
  // Those of `lanes` that Unexplained().
  kernel::LaneBits UnexplainedOf(kernel::LaneBits lanes) const;
  // Of the second batch: `values` with albedos fitted.
  void FitAlbedosOf(kernel::LaneBits lanes, Candidates* candidates);
  void TryRoughnesses(kernel::LaneBits lanes, const std::array<TexelValues, kBatch>& from);
  void TrySolve(kernel::LaneBits lanes, const Candidates& from);

  BatchEvaluator evaluator_;
  kernel::SolveOptions solve_;
  int starts_;
  double variance_ = 0.0;
  From from_ = From::kStart;
  Gather gather_;
  Done done_;
  Batch first_, slow_, second_;
};

}  // namespace glint
