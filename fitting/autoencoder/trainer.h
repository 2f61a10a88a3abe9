// Trains the auto-encoder.
//
// Loss, after DIR 2019 eq. 6 and 7 (all terms means over what they sum):
//   |M − D(z)|₁  +  smoothness · |D(z) − D(z + ξ)|₁  +  render_weight · Σ_views |log R(M) − log R(D(z))|₁ / views
// with M the encoded maps, z = E(M), ξ ~ N(0, noise_variance). Adam, a learning rate that warms up and
// then falls as a cosine, and a moving average of the weights, which is what is written.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "fitting/autoencoder/material_pool.h"

namespace glint {

struct TrainOptions {
  std::array<int, 5> channels{48, 96, 192, 384, 384};  // last: the latent code's
  std::int64_t steps = 0;         // 0: until `minutes` are over
  double minutes = 0;             // training time, counted over all resumes
  int batch = 16;
  int crop = 128;                 // texels; a multiple of 32
  double learning_rate = 5e-4;
  int warmup_steps = 200;
  double smoothness = 0.5;        // DIR: 2
  double smoothness_share = 0.5;  // share of the batch that is decoded a second time
  double noise_variance = 0.2;
  double render_weight = 0.3;     // 0: no renderings
  int render_views = 3;           // per sample; a third cosine-distributed, the others on highlights
  double average_decay = 0.999;
  double normal_weight = 1.0;     // of the normals' L1 among the maps
  bool principal_start = true;    // start from principal components (principal_start.h), not noise
  bool bf16 = true;               // where the CPU multiplies it natively
  int threads = 1;
  std::uint64_t seed = 1;
  double checkpoint_minutes = 3;  // also how often validation runs
  PoolOptions pool;
  std::string data_name;          // written into the weights' metadata
};

// One line of the log.
struct TrainProgress {
  std::int64_t step = 0;
  double seconds = 0;             // of training, resumes included
  double samples_per_second = 0;
  double eta_seconds = 0;
  double learning_rate = 0;
  double loss = 0, map_loss = 0, smoothness_loss = 0, render_loss = 0;  // means since the last line
  std::optional<double> validation_map_loss;  // L1 of encoded maps, averaged weights
};

struct TrainFiles {
  std::filesystem::path weights;     // the result, rewritten at each checkpoint
  std::filesystem::path checkpoint;  // optimiser and all; empty: <weights>.checkpoint
  std::filesystem::path log_csv;     // empty: <weights>.csv; appended to when resuming
  bool resume = false;               // go on from the checkpoint when it exists
};

// Throws std::runtime_error for options that cannot be and files that cannot be read or written.
// `validation`: materials that training never sees. Returns the last progress.
TrainProgress Train(const TrainOptions& options, const TrainFiles& files,
                    const MaterialSource& materials, const MaterialSource& validation,
                    const std::function<void(const TrainProgress&)>& report);

}  // namespace glint
