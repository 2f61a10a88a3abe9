// Texels' observations out of the photographs.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "fitting/refine/refine.h"
#include "fitting/texel/texel_batch.h"

namespace glint {

// Replaces what `observations` holds by those of at most a batch of texels, each in its lane. The
// room lights them as if they were as `maps` say (it changes slowly with the normal, and is faint).
// `views`: those to take, by their place in `problem`.
void GatherObservations(const RefineProblem& problem, const SvbrdfMaps& maps,
                        std::span<const size_t> texels, std::span<const int> views,
                        BatchObservations* observations);

// The same of texels that are asked for again and again with other views, as those sampled are in
// cross-validation: what is gathered once of a batch is kept, 1.7 KB a view. Several threads may
// ask at once.
class GatheredObservations {
 public:
  // Both must outlive this.
  GatheredObservations(const RefineProblem& problem, const SvbrdfMaps& maps);

  void Of(std::span<const size_t> texels, std::span<const int> views,
          BatchObservations* observations);
  // What was kept: the problem's views are others from now on.
  void Forget();

 private:
  struct Batch {
    std::vector<size_t> texels;
    BatchObservations all;
  };
  std::shared_ptr<const Batch> Find(std::span<const size_t> texels);

  const RefineProblem& problem_;
  const SvbrdfMaps& maps_;
  std::vector<int> all_views_;
  std::mutex mutex_;
  std::map<size_t, std::shared_ptr<const Batch>> batches_;  // by their first texel
};

}  // namespace glint
