#include "fitting/latent/descent.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fitting/autoencoder/adam.h"

namespace glint {
namespace {

constexpr double kFall = 0.3;       // of the learning rate, each time progress ends
constexpr int kMostFalls = 3;       // then the descent has converged
constexpr double kLastPart = 0.75;  // of the iterations; after it the rate falls in any case

}  // namespace

Descent::Descent(const DescentOptions& options, size_t size)
    : options_(options), moment1_(size), moment2_(size), rate_(options.learning_rate) {}

void Descent::Offer(double loss, std::span<const float> values) {
  if (!std::isfinite(loss)) throw std::runtime_error("fitting: the loss is not finite");
  if (loss >= best_loss_) return;
  best_loss_ = loss;
  best_.assign(values.begin(), values.end());
}

void Descent::Step(double loss, std::span<const float> gradient, std::span<float> values) {
  losses_.push_back(loss);
  Offer(loss, values);
  LowerRate();
  ++step_;
  // The last quarter ends at a tenth of the rate, so that a descent cut short still settles.
  const double rest =
      (static_cast<double>(step_) / options_.iterations - kLastPart) / (1 - kLastPart);
  const double settle = rest > 0 ? std::pow(0.1, rest) : 1.0;
  AdamStep({rate_ * settle, 0.5, 0.99}, step_, gradient, values, moment1_, moment2_);
}

void Descent::LowerRate() {
  if (step_ < mark_ + options_.patience) return;
  const bool progress = best_loss_ < mark_loss_ * (1 - options_.tolerance);
  mark_ = step_;
  mark_loss_ = best_loss_;
  if (progress) return;
  if (++falls_ > kMostFalls) {
    converged_ = true;
  } else {
    rate_ *= kFall;
  }
}

}  // namespace glint
