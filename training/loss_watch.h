// Tells a training whose loss has jumped from one whose loss merely varies.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>

namespace glint {

// Of logarithms of the loss, so that it does not matter how far a training has come. The recent
// level is their median, their scatter the median absolute deviation, which one jump does not move.
struct LossWatchOptions {
  size_t window = 32;  // losses that make the recent level
  size_t least = 4;    // losses before there is a level
  // A loss is suspicious beyond so many robust standard deviations of its level, and beyond a
  // factor below which nothing is done about it: batches differ, and a training lives with it.
  double deviations = 6;
  double least_factor = 1.3;
  // One loss beyond this factor, or this many suspicious ones in a row, are a jump. Outputs at the
  // ends of their ranges have five to seven times a trained network's loss.
  double sure_factor = 2;
  int patience = 2;
  // Where losses scatter so much that this factor is within the deviations: so many beyond it in a
  // row, since scatter does not stay up.
  int scatter_patience = 4;
};

enum class LossVerdict { kCalm, kSuspicious, kJumped };

class LossWatch {
 public:
  explicit LossWatch(const LossWatchOptions& options = {}) : options_(options) {}

  // The next loss, a mean over some steps: of maps and renderings, which stay above 0 where a
  // likelihood takes their sum below. Not finite: a jump.
  LossVerdict Judge(double loss);

  // The losses of a training's log, as if they had been judged: where a resumed one stands.
  void Remember(const std::filesystem::path& log_csv);

  // Forgets the suspicious losses, not the level.
  void Calm() { suspicious_ = up_ = 0; }

 private:
  void Keep(double log_loss);

  LossWatchOptions options_;
  std::deque<double> logs_;
  int suspicious_ = 0, up_ = 0;  // in a row: beyond the deviations; beyond the sure factor
};

}  // namespace glint
