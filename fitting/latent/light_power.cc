#include "fitting/latent/light_power.h"

#include <cmath>

#include "base/model/estimate.h"
#include "base/resampling/resampling.h"
#include "fitting/encoding/encoding.h"
#include "fitting/latent/fit_loss.h"

namespace glint {
PhotographSet WithPower(PhotographSet set, double factor) {
  for (Photograph& photograph : set.photographs) {
    for (double& power : photograph.view.light_rgb) power *= factor;
  }
  return set;
}

PowerEstimate EstimatePower(const Estimator& estimator, const PhotographSet& set,
                            const EstimatorConditions& conditions, int threads) {
  const auto [width, height] =
      SizeAtMost(set.plane.width, set.plane.height, Estimator::kGlobalSize);
  const PhotographSet small = Downsampled(set, width, height, threads);
  const auto loss = [&](double octaves) {
    const PhotographSet lit = WithPower(small, std::exp2(octaves));
    const SvbrdfEstimate estimate = estimator.Estimate(lit, conditions, threads);
    return FitLoss(lit, threads).Evaluate(EncodeMaps(estimate.maps), 1, false).loss;
  };
  double best = 0;
  PowerEstimate power;
  power.log_l1 = power.as_given = loss(0);
  const auto offer = [&](double octaves) {
    const double here = loss(octaves);
    if (!(here < power.log_l1)) return;
    power.log_l1 = here;
    best = octaves;
  };
  for (int step = 1; step <= constants::kPowerReach_octaves; ++step) {
    for (const int way : {-1, 1}) offer(way * step * constants::kPowerStep_octaves);
  }
  const double coarse = best;
  for (const int way : {-1, 1}) offer(coarse + 0.5 * way * constants::kPowerStep_octaves);
  power.factor = std::exp2(best);
  return power;
}

}  // namespace glint
