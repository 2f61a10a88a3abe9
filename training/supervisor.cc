#include "training/supervisor.h"

#include <stdexcept>

namespace glint {
namespace {

// Calm losses that bear a snapshot out: a divergence shows within a few seconds of its beginning.
constexpr int kConfirming = 3;
constexpr int kMostReturns = 6;  // to one snapshot: a 64th of the rate
constexpr double kRateFactor = 0.5;

}  // namespace

Supervisor::Supervisor(const std::filesystem::path& log_csv, const FlatState& flat,
                       const TrainState& state)
    : good_(flat, state) {
  if (!log_csv.empty()) watch_.Remember(log_csv);
}

LossVerdict Supervisor::Judge(double loss, const FlatState& flat, const TrainState& state) {
  const LossVerdict verdict = watch_.Judge(loss);
  if (verdict != LossVerdict::kCalm) return verdict;
  if (!candidate_) {
    candidate_.emplace(flat, state);
    calm_ = 0;
  } else if (++calm_ >= kConfirming) {
    good_ = *std::move(candidate_);
    candidate_.emplace(flat, state);
    calm_ = 0;
    returns_ = 0;
  }
  return verdict;
}

std::string Supervisor::GoBack(FlatState* flat, TrainState* state) {
  const std::int64_t from = state->step;
  if (++returns_ > kMostReturns) {
    throw std::runtime_error("training: the loss jumped " + std::to_string(returns_) +
                             " times after step " + std::to_string(good_.step()) +
                             " although the learning rate was halved each time; resume from an "
                             "earlier checkpoint or begin again with a lower --lr");
  }
  good_.Restore(flat, state);
  state->rate_factor *= kRateFactor;
  candidate_.reset();
  watch_.Calm();
  return "the loss jumped before step " + std::to_string(from) + ": back to step " +
         std::to_string(state->step) + " with half the learning rate";
}

}  // namespace glint
