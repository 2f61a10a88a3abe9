#include "fitting/refine/sample_part.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "base/model/substances.h"
#include "base/parallel/parallel.h"
#include "base/reflectance/log_radiance.h"
#include "fitting/refine/gather.h"
#include "fitting/refine/lower_median.h"

namespace glint {
namespace {

// Median over the views of π·I/(E·NoL), the albedo of a matte texel: highlights are rare among
// them.
std::vector<float> MedianColour(const RefineProblem& problem, const SvbrdfMaps& initial,
                                int threads) {
  using Obs = BatchObservations;
  const size_t texels = initial.texels();
  const int views = static_cast<int>(problem.views.size());
  RefineProblem without_environment = problem;
  without_environment.environment = {};
  std::vector<int> all(problem.views.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<float> colour(3 * texels);
  ForEachBlock(static_cast<int>(texels), 64 * kBatch, threads, [&](int begin, int end) {
    Obs seen(views);
    std::vector<float> values;
    for (int first = begin; first < end; first += kBatch) {
      std::array<size_t, kBatch> batch;
      std::iota(batch.begin(), batch.end(), static_cast<size_t>(first));
      const int count = std::min(kBatch, end - first);
      GatherObservations(without_environment, initial,
                         std::span(batch).first(static_cast<size_t>(count)), all, &seen);
      for (int lane = 0; lane < count; ++lane) {
        for (int c = 0; c < 3; ++c) {
          values.clear();
          for (int v = 0; v < views; ++v) {
            if (!seen.sees(v, lane)) continue;
            const auto at = [&](int plane) { return seen.rows()[v * Obs::kPlanes + plane][lane]; };
            const float radiance = 1 / at(Obs::kInverseTarget + c) - static_cast<float>(kLogOffset);
            const float received =
                at(Obs::kIrradiance + c) * std::max(constants::kLeastIncidence, at(Obs::kLightZ));
            values.push_back(std::numbers::pi_v<float> * radiance / received);
          }
          colour[static_cast<size_t>(c) * texels + batch[static_cast<size_t>(lane)]] =
              LowerMedian(&values);
        }
      }
    }
  });
  return colour;
}

}  // namespace

TexelLooks LooksOf(const RefineProblem& problem, const SvbrdfMaps& initial, const SampleLook& look,
                   bool with_gloss, int threads) {
  return {MedianColour(problem, initial, threads),
          with_gloss ? look.GlossOf(problem, threads) : std::vector<float>()};
}

SamplePart::SamplePart(const RefineProblem& problem, const SvbrdfMaps& initial,
                       SampleSubstances known, const TexelLooks& looks, int threads)
    : problem_(problem),
      initial_(initial),
      known_(std::move(known)),
      shares_(known_.substances.SharesOf(looks, threads)) {}

SamplePart::SamplePart(const RefineProblem& problem, const SvbrdfMaps& initial,
                       const SampleSubstances& known, int threads)
    : SamplePart(problem, initial, known,
                 LooksOf(problem, initial, known.look, known.substances.by_gloss(), threads),
                 threads) {}

}  // namespace glint
