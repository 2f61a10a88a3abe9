#include "fitting/autoencoder/adam.h"

#include <cmath>

namespace glint {

void AdamStep(const AdamOptions& options, std::int64_t step, std::span<const float> gradient,
              std::span<float> weights, std::span<float> moment1, std::span<float> moment2) {
  const double t = static_cast<double>(step);
  const double correction2 = std::sqrt(1.0 - std::pow(options.beta2, t));
  const float rate =
      static_cast<float>(options.learning_rate * correction2 / (1.0 - std::pow(options.beta1, t)));
  const float epsilon = static_cast<float>(options.epsilon * correction2);
  const float b1 = static_cast<float>(options.beta1), b2 = static_cast<float>(options.beta2);
  float* w = weights.data();
  float* m = moment1.data();
  float* v = moment2.data();
  const float* g = gradient.data();
  for (size_t i = 0; i < weights.size(); ++i) {
    m[i] = b1 * m[i] + (1.0f - b1) * g[i];
    v[i] = b2 * v[i] + (1.0f - b2) * g[i] * g[i];
    w[i] -= rate * m[i] / (std::sqrt(v[i]) + epsilon);
  }
}

void MoveAverage(double decay, std::span<const float> weights, std::span<float> average) {
  const float share = static_cast<float>(1.0 - decay);
  for (size_t i = 0; i < weights.size(); ++i) average[i] += share * (weights[i] - average[i]);
}

}  // namespace glint
