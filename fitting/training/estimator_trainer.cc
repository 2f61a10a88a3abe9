#include "fitting/training/estimator_trainer.h"

#include <stdexcept>

#include "fitting/estimator/estimator_file.h"
#include "fitting/layers/layers.h"
#include "fitting/training/map_batches.h"
#include "fitting/training/map_losses.h"
#include "fitting/training/train_loop.h"
#include "fitting/training/training_photographs.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr std::uint64_t kShotStream = 0x5EED0004;

EstimatorChannels ChannelsOf(const EstimatorTrainOptions& options) {
  EstimatorChannels channels;
  if (options.channels.size() != kEstimatorLevels + 2) {
    throw std::runtime_error("training options: found " + std::to_string(options.channels.size()) +
                             " channels; the estimator has seven: five levels, full, global");
  }
  std::copy_n(options.channels.begin(), kEstimatorLevels, channels.levels.begin());
  channels.full = options.channels[kEstimatorLevels];
  channels.global = options.channels[kEstimatorLevels + 1];
  return channels;
}

class EstimatorTraining : public Trainable {
 public:
  EstimatorTraining(const EstimatorTrainOptions& options, std::int64_t first_batch,
                    const MaterialSource& materials, const MaterialSource& validation)
      : options_(options),
        compute_(options.bf16 ? FastComputeType() : torch::kFloat32),
        map_weights_(MapWeights(options)),
        pool_(options, materials, first_batch),
        validation_maps_(ValidationMaps(validation, options.pool.material_size)),
        network_(EstimatorNetwork::Random(ChannelsOf(options), options.seed)),
        average_(Clone(&network_)) {}

  NamedTensors State() override { return network_.State(); }
  NamedTensors AverageState() override { return average_.State(); }
  size_t learned() const override { return EstimatorNetwork(network_).State().size(); }
  std::map<std::string, std::string> Description() const override {
    return EstimatorMetadata(network_);
  }
  void SaveWeights(const std::filesystem::path& path,
                   std::map<std::string, std::string> metadata) override {
    SaveEstimator(path, &average_, std::move(metadata));
  }

  double Validate() override {
    torch::NoGradGuard no_gradient;
    double sum = 0;
    for (int64_t i = 0; i < validation_maps_.size(0); ++i) {
      const Tensor truth = validation_maps_.slice(0, i, i + 1);
      Stream random(static_cast<std::uint64_t>(i));
      const PhotographBatch shown = PhotographMaps(truth, &random, true);
      const Tensor maps = average_.Forward(shown.features, shown.profiles, compute_);
      sum += (maps - truth).abs().mean().item<double>();
    }
    return sum / static_cast<double>(validation_maps_.size(0));
  }

  StepLosses Forward(std::int64_t step) override {
    const Tensor truth = pool_.Sample(step);
    Stream random(StreamSeed(options_.seed ^ kShotStream, static_cast<std::uint64_t>(step)));
    const PhotographBatch shown = PhotographMaps(truth, &random, false);
    const Tensor maps = network_.Forward(shown.features, shown.profiles, compute_);
    StepLosses losses;
    const Tensor map = ((maps - truth).abs() * map_weights_).mean();
    losses.map = map.item<double>();
    losses.total = options_.map_weight * map;
    if (options_.render_weight > 0 && options_.render_views > 0) {
      const Tensor render = RenderLossOf(maps, truth, options_, step);
      losses.render = render.item<double>();
      losses.total = losses.total + options_.render_weight * render;
    }
    return losses;
  }

 private:
  const EstimatorTrainOptions options_;
  const torch::Dtype compute_;
  const Tensor map_weights_;
  MapBatches pool_;
  const Tensor validation_maps_;
  EstimatorNetwork network_, average_;
};

}  // namespace

TrainProgress TrainEstimator(const EstimatorTrainOptions& options, const TrainFiles& files,
                             const MaterialSource& materials, const MaterialSource& validation,
                             const TrainReport& report) {
  CheckTrainOptions(options);
  torch::set_num_threads(options.threads);
  EstimatorTraining training(options, FirstStep(files) * options.accumulate, materials, validation);
  return RunTraining(options, files, &training, report);
}

}  // namespace glint
