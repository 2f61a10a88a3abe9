// Adam (Kingma, Ba 2015) with an exponential moving average of the weights, one pass over memory.
#pragma once

#include <cstdint>
#include <span>

namespace glint {

struct AdamOptions {
  double learning_rate = 1e-4;
  double beta1 = 0.5;
  double beta2 = 0.999;
  double epsilon = 1e-8;
};

// One step, `step` counted from 1. `moment1`, `moment2` start at zero; all spans have one size.
void AdamStep(const AdamOptions& options, std::int64_t step, std::span<const float> gradient,
              std::span<float> weights, std::span<float> moment1, std::span<float> moment2);

// average += (1 − decay)·(weights − average)
void MoveAverage(double decay, std::span<const float> weights, std::span<float> average);

}  // namespace glint
