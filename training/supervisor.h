// Takes a training back to where it was good when its loss jumps. Include from .cc files only:
// pulls in torch.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "training/flat_state.h"
#include "training/loss_watch.h"

namespace glint {

// Keeps two snapshots in the device's memory: the last one whose weights later losses have borne
// out, and one that is still to be borne out.
class Supervisor {
 public:
  // `log_csv`: a resumed training's log, from which the loss's level is taken; empty: none.
  Supervisor(const std::filesystem::path& log_csv, const FlatState& flat, const TrainState& state);

  // The loss of the steps since the last call, which end in `state`.
  LossVerdict Judge(double loss, const FlatState& flat, const TrainState& state);

  // Puts the last good values back and halves the learning rate. Says what it did. Throws
  // std::runtime_error when half the rate has not helped several times from the same snapshot.
  std::string GoBack(FlatState* flat, TrainState* state);

 private:
  LossWatch watch_;
  Snapshot good_;
  std::optional<Snapshot> candidate_;
  int calm_ = 0;     // losses since the candidate
  int returns_ = 0;  // to the same snapshot
};

}  // namespace glint
