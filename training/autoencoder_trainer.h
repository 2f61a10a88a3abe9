// Trains the auto-encoder.
//
// Loss, after DIR 2019 eq. 6 and 7 (all terms means over what they sum):
//   map_weight · |M − D(z)|₁  +  smoothness · |D(z) − D(z + ξ)|₁  +  render_weight · Σ_views |log
//   R(M) − log R(D(z))|₁ / views
// with M the encoded maps, z = E(M), ξ ~ N(0, noise_variance). Adam, a learning rate that warms up
// and then falls as a cosine, and a moving average of the weights, which is what is written.
#pragma once

#include <array>

#include "training/train_options.h"

namespace glint {

struct AutoencoderTrainOptions : TrainOptions {
  std::array<int, 5> channels{48, 96, 192, 384, 384};  // last: the latent code's
  double smoothness = 0.5;                             // DIR: 2
  double smoothness_share = 0.5;  // share of the batch that is decoded a second time
  double noise_variance = 0.2;
  bool principal_start = true;  // start from principal components (principal_start.h), not noise
  std::string normalisation = "code";  // none, code or all (network.h)
};

// Throws std::runtime_error for options that cannot be and files that cannot be read or written.
// `validation`: materials that training never sees. Returns the last progress.
TrainProgress TrainAutoencoder(const AutoencoderTrainOptions& options, const TrainFiles& files,
                               const MaterialSource& materials, const MaterialSource& validation,
                               const TrainReport& report);

}  // namespace glint
