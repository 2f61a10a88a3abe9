// Trains the estimator of maps from any number of photographs (fitting/estimator).
//
// Each sample is a crop of a material with 1 to 9 photographs of it, drawn as real captures are
// (training_photographs.h): with a flash beside the lens, errors of exposure, light, registration
// and tone curve, ambient illumination, and shading that the model does not know. Loss:
//   L1 of the encoded maps  +  render_weight · log-L1 of renderings under other views and lights
//   +  spread_weight · Σ ( |error| / b + ln b ),   the Laplace likelihood of the predicted spread
//   b,
// of which the errors are not pulled by the last term, so that the maps do not pay for it (Kendall
// and Gal 2017 for the likelihood; Deschaintre et al. 2019 for the many photographs).
#pragma once

#include "training/train_options.h"

namespace glint {

struct EstimatorTrainOptions : TrainOptions {
  // A step as long as a few of drawn weights' first ones puts all outputs where tanh is flat, and
  // no gradient brings them back (docs/experiments/training.md).
  EstimatorTrainOptions() { max_gradient_norm = 0.5; }
  std::vector<int> channels{32,  64, 128, 224,
                            320, 24, 192};  // five levels, full resolution, global
  std::string network = "pooled";           // "attended", "descent" (estimator_network.h)
  double spread_weight = 0.05;
  // Photographs in a batch, at most (one sample has them all at least): time and memory.
  int batch_photographs = 16;
};

// As TrainAutoencoder().
TrainProgress TrainEstimator(const EstimatorTrainOptions& options, const TrainFiles& files,
                             const MaterialSource& materials, const MaterialSource& validation,
                             const TrainReport& report);

}  // namespace glint
