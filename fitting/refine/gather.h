// Texels' observations out of the photographs.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "fitting/refine/refine.h"
#include "fitting/texel/texel_batch.h"

namespace glint {

// Replaces what `observations` holds by those of at most a batch of texels, each in its lane.
// Environment lighting is reflected with the normals and roughness of `maps` (it changes slowly
// with the normal, and is faint). `views`: those to take, by their place in `problem`.
void GatherObservations(const RefineProblem& problem, const SvbrdfMaps& maps,
                        std::span<const size_t> texels, std::span<const int> views,
                        BatchObservations* observations);

// The same of texels that are asked for again and again, as those sampled are in cross-validation:
// what is gathered once of a batch in some views is kept, 1.7 KB a view, up to kMostBytes. Several
// threads may ask at once.
class GatheredObservations {
 public:
  // Cross-validation of 2,048 texels and their neighbours by sixty photographs.
  static constexpr size_t kMostBytes = size_t{192} << 20;

  // Both must outlive this.
  GatheredObservations(const RefineProblem& problem, const SvbrdfMaps& maps);

  // What is kept stays where it is until Forget(); what is not is gathered into `buffer`.
  const BatchObservations& Of(std::span<const size_t> texels, std::span<const int> views,
                              BatchObservations* buffer);
  // The problem's views are others from now on.
  void Forget();

 private:
  using Key = std::pair<std::vector<size_t>, std::vector<int>>;  // texels, views

  const RefineProblem& problem_;
  const SvbrdfMaps& maps_;
  std::mutex mutex_;
  size_t bytes_ = 0;
  std::map<Key, std::unique_ptr<const BatchObservations>> kept_;
};

}  // namespace glint
