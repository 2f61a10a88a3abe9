// Options and progress of trainings.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "training/material_pool.h"

namespace glint {

struct TrainOptions {
  std::int64_t steps = 0;  // 0: until `minutes` are over
  double minutes = 0;      // training time, in total, over all resumed runs
  int batch = 16;
  // Texels, multiples of 32; each step's is one of them. Batches of larger ones than the first hold
  // fewer, as many texels.
  std::vector<int> crops{128};
  double learning_rate = 5e-4;  // the highest; it rises over `warmup_steps`, then falls as a cosine
  double max_gradient_norm = 0;  // of a step; longer gradients are scaled down to it; 0: none is
  int warmup_steps = 200;
  std::int64_t warmup_from = 0;  // the step it rises from: a checkpoint's, when a resume lengthens
  int accumulate = 1;            // batches whose gradients make one step
  double map_weight = 1.0;       // of the maps' L1; 0: none
  double render_weight = 0.3;    // of the renderings' log-L1; 0: none
  int render_views = 3;          // per sample; a third cosine-distributed, the others on highlights
  double normal_weight = 1.0;    // of the normals' L1 among the maps
  double average_decay = 0.999;  // of the moving average of weights, which is what is written
  bool bf16 = true;              // where the device multiplies it natively
  std::string device = "cpu";    // or "cuda", where this libtorch has it
  int threads = 1;
  std::uint64_t seed = 1;
  std::filesystem::path from;     // weights to begin with; empty: new ones
  double checkpoint_minutes = 3;  // also how often validation runs
  double report_seconds = 5;      // between lines of the log
  int batches_ahead = 3;          // cut while the device works
  // Whether a jump of the loss (loss_watch.h) takes the training back to where it was good, with
  // half the learning rate. Without, a loss that is not finite ends it.
  bool supervise = false;
  std::int64_t test_jump_step = 0;  // for tests: the step after which the weights are spoilt, once
  PoolOptions pool;
  std::string data_name;  // written into the weights' metadata
};

struct TrainFiles {
  std::filesystem::path weights;       // the result, rewritten at each checkpoint
  std::filesystem::path checkpoint;    // optimiser and all; empty: <weights>.checkpoint
  std::filesystem::path log_csv;       // empty: <weights>.csv; appended to when resuming
  bool resume = false;                 // go on from the checkpoint when it exists
  std::filesystem::path float32 = {};  // the result in float32 beside; empty: none

  std::filesystem::path CheckpointPath() const;
  std::filesystem::path LogPath() const;
  std::filesystem::path PlotPath() const;  // the log as a picture, beside it
};

// One line of the log.
struct TrainProgress {
  std::int64_t step = 0;
  double seconds = 0;  // of training, resumes included
  double samples_per_second = 0;
  double eta_seconds = 0;
  double learning_rate = 0;
  double loss = 0, map_loss = 0, smoothness_loss = 0, render_loss = 0;  // means since the last line
  std::optional<double> validation_map_loss;  // L1 of encoded maps, averaged weights
  double wait_share = 0;  // of the time since the last line, spent waiting for batches
  std::string event;      // what happened besides; empty: nothing
};

using TrainReport = std::function<void(const TrainProgress&)>;

}  // namespace glint
