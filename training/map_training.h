// What the trainings of networks that give encoded maps share: the batches, the network beside its
// moving average, the losses of maps, validation. Include from .cc files only: pulls in torch.
#pragma once

#include "fitting/layers/layers.h"
#include "training/map_batches.h"
#include "training/map_losses.h"
#include "training/train_loop.h"

namespace glint {

// Network has State(); Clone(Network*) copies it. Options are TrainOptions or derived from them.
template <class Network, class Options>
class MapTraining : public Trainable {
 public:
  NamedTensors State() override { return network_.State(); }
  NamedTensors AverageState() override { return average_.State(); }
  double samples_per_batch() const override { return options_.batch; }
  double waited_seconds() const override { return pool_.waited_seconds(); }

  double Validate() override {
    torch::NoGradGuard no_gradient;
    double sum = 0;
    for (int64_t i = 0; i < validation_maps_.size(0); ++i) {
      const torch::Tensor truth = validation_maps_.slice(0, i, i + 1);
      sum += (AveragedMaps(truth, i) - truth).abs().mean().template item<double>();
    }
    return sum / static_cast<double>(validation_maps_.size(0));
  }

 protected:
  // `shape_of` is of each step's batch, empty: as the options say; `first_weights(MapBatches*)`
  // makes the network to begin with.
  template <class FirstWeights>
  MapTraining(const Options& options, std::int64_t first_batch, const MaterialSource& materials,
              const MaterialSource& validation, MapBatches::ShapeOf shape_of,
              const FirstWeights& first_weights)
      : options_(options),
        device_(options.device),
        compute_(options.bf16 ? FastComputeType(device_) : torch::kFloat32),
        pool_(options, materials, first_batch, std::move(shape_of)),
        network_(OnDevice(first_weights(&pool_), device_)),
        average_(Clone(&network_)),
        map_weights_(MapWeights(options).to(device_)),
        validation_maps_(ValidationMaps(validation, options.pool.material_size).to(device_)) {}

  // The maps that the averaged weights give for validation material `number`, [1, 9, S, S].
  virtual torch::Tensor AveragedMaps(const torch::Tensor& truth, std::int64_t number) = 0;

  // The L1 that counts, of a difference of encoded maps.
  torch::Tensor WeightedL1(const torch::Tensor& difference) const {
    return (difference.abs() * map_weights_).mean();
  }

  void AddMapLoss(const torch::Tensor& maps, const torch::Tensor& truth, StepLosses* losses) const {
    const torch::Tensor map = WeightedL1(maps - truth);
    losses->map = map.detach();
    Add(options_.map_weight * map, losses);
  }

  void AddRenderLoss(const torch::Tensor& maps, const torch::Tensor& truth, std::int64_t step,
                     StepLosses* losses) const {
    if (options_.render_weight <= 0 || options_.render_views <= 0) return;
    const torch::Tensor render = RenderLossOf(maps, truth, options_, step);
    losses->render = render.detach();
    Add(options_.render_weight * render, losses);
  }

  static void Add(const torch::Tensor& loss, StepLosses* losses) {
    losses->total = losses->total.defined() ? losses->total + loss : loss;
  }

  const Options options_;
  const torch::Device device_;
  const torch::Dtype compute_;
  MapBatches pool_;
  Network network_, average_;

 private:
  static Network OnDevice(Network network, torch::Device device) {
    for (auto& [name, tensor] : network.State()) *tensor = tensor->to(device);
    return network;
  }

  const torch::Tensor map_weights_;
  const torch::Tensor validation_maps_;
};

}  // namespace glint
