// Trains the single-photo estimator.
//
// Each sample is a crop of a material, taken as the whole sample of [−1, 1]² or a part or multiple
// of it, photographed once with a flash at or near the camera: from the top mostly, up to 45°
// beside it else; too bright and too dark, 8 bits (gamma 2.2) mostly, float now and then; the
// light's power known more or less. Loss: L1 of the encoded maps + render_weight · log-L1 of
// renderings under other views and lights (Deschaintre et al. 2018; the views are those of the
// auto-encoder's loss).
#pragma once

#include "fitting/training/train_options.h"

namespace glint {

struct EstimatorTrainOptions : TrainOptions {
  std::vector<int> channels{24, 48, 96, 160, 256, 16, 128};  // five levels, full resolution, global
};

// As TrainAutoencoder().
TrainProgress TrainEstimator(const EstimatorTrainOptions& options, const TrainFiles& files,
                             const MaterialSource& materials, const MaterialSource& validation,
                             const TrainReport& report);

}  // namespace glint
