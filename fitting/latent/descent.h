// Adam with a learning rate that falls when the loss no longer does, and the stop that follows.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace glint {

struct DescentOptions {
  int iterations = 300;
  double learning_rate = 0.03;
  double tolerance = 0.003;  // relative fall over `patience` iterations below which the rate falls
  int patience = 25;
};

// Feed losses and gradients, one per iteration; keeps the values of the lowest loss.
class Descent {
 public:
  Descent(const DescentOptions& options, size_t size);

  // Whether another iteration is due.
  bool Going() const { return !converged_ && step_ < options_.iterations; }
  bool converged() const { return converged_; }
  const std::vector<double>& losses() const { return losses_; }

  // `values` had `loss` and `gradient`; they take a step. Another optimiser: replace AdamStep here.
  void Step(double loss, std::span<const float> gradient, std::span<float> values);
  double rate() const { return rate_; }

  // Values of the lowest loss seen, and that loss. `values` after the last step were never
  // evaluated, so a caller may offer them with their loss first.
  void Offer(double loss, std::span<const float> values);
  const std::vector<float>& best() const { return best_; }
  double best_loss() const { return best_loss_; }

 private:
  void LowerRate();

  DescentOptions options_;
  std::vector<float> moment1_, moment2_, best_;
  std::vector<double> losses_;
  double best_loss_ = std::numeric_limits<double>::infinity();
  double rate_;
  double mark_loss_ = std::numeric_limits<double>::infinity();
  int mark_ = 0;
  int step_ = 0;
  int falls_ = 0;
  bool converged_ = false;
};

}  // namespace glint
