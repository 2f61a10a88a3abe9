#include "fitting/training/autoencoder_trainer.h"

#include <cmath>
#include <stdexcept>

#include "fitting/autoencoder/network_file.h"
#include "fitting/layers/layers.h"
#include "fitting/training/map_batches.h"
#include "fitting/training/map_losses.h"
#include "fitting/training/principal_start.h"
#include "fitting/training/random.h"
#include "fitting/training/train_loop.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr double kBatchStatisticsMomentum = 0.005;
constexpr std::uint64_t kNoiseStream = 0x5EED0001;
constexpr int kPrincipalSamples = 192;

AutoencoderNetwork FirstWeights(const AutoencoderTrainOptions& options, std::int64_t first_batch,
                                MapBatches* pool) {
  const Normalisation normalisation = ParseNormalisation(options.normalisation);
  // The components stand on a code that is normalised and on levels that are not.
  if (first_batch > 0 || !options.principal_start || normalisation != Normalisation::kCode) {
    return AutoencoderNetwork::Random(options.channels, options.seed, normalisation);
  }
  return StartFromPrincipalComponents(options.channels, pool->SampleFirst(kPrincipalSamples));
}

class AutoencoderTraining : public Trainable {
 public:
  AutoencoderTraining(const AutoencoderTrainOptions& options, std::int64_t first_batch,
                      const MaterialSource& materials, const MaterialSource& validation)
      : options_(options),
        compute_(options.bf16 ? FastComputeType() : torch::kFloat32),
        map_weights_(MapWeights(options)),
        pool_(options, materials, first_batch),
        validation_maps_(ValidationMaps(validation, options.pool.material_size)),
        network_(FirstWeights(options, first_batch, &pool_)),
        average_(Clone(&network_)) {}

  NamedTensors State() override { return network_.State(); }
  NamedTensors AverageState() override { return average_.State(); }
  size_t learned() const override { return AutoencoderNetwork(network_).Parameters().size(); }
  std::map<std::string, std::string> Description() const override {
    return NetworkMetadata(network_);
  }
  void SaveWeights(const std::filesystem::path& path,
                   std::map<std::string, std::string> metadata) override {
    SaveNetwork(path, &average_, std::move(metadata));
  }

  double Validate() override {
    torch::NoGradGuard no_gradient;
    double sum = 0;
    for (int64_t i = 0; i < validation_maps_.size(0); ++i) {
      const Tensor one = validation_maps_.slice(0, i, i + 1);
      const Tensor z = average_.NormaliseByRunning(average_.EncodeRaw(one, compute_));
      sum += (average_.Decode(z, compute_) - one).abs().mean().item<double>();
    }
    return sum / static_cast<double>(validation_maps_.size(0));
  }

  StepLosses Forward(std::int64_t step) override {
    const Tensor batch = pool_.Sample(step);
    StepLosses losses;
    const int64_t count = batch.size(0);
    const int64_t twice = options_.smoothness > 0
                              ? std::lround(options_.smoothness_share * static_cast<double>(count))
                              : 0;
    const Tensor z = network_.EncodeForTraining(batch, compute_, kBatchStatisticsMomentum);
    Tensor codes = z;
    if (twice > 0) {
      auto generator = torch::make_generator<torch::CPUGeneratorImpl>(
          StreamSeed(options_.seed ^ kNoiseStream, static_cast<std::uint64_t>(step)));
      const Tensor part = z.slice(0, 0, twice);
      const Tensor noise =
          torch::randn(part.sizes(), generator) * std::sqrt(options_.noise_variance);
      codes = torch::cat({z, part + noise}, 0);
    }
    const Tensor decoded = network_.DecodeForTraining(codes, compute_, kBatchStatisticsMomentum);
    const Tensor plain = decoded.slice(0, 0, count);
    const Tensor map = ((plain - batch).abs() * map_weights_).mean();
    losses.map = map.item<double>();
    losses.total = options_.map_weight * map;
    if (twice > 0) {
      const Tensor moved = decoded.slice(0, count, count + twice) - decoded.slice(0, 0, twice);
      const Tensor smoothness = (moved.abs() * map_weights_).mean();
      losses.smoothness = smoothness.item<double>();
      losses.total = losses.total + options_.smoothness * smoothness;
    }
    if (options_.render_weight > 0 && options_.render_views > 0) {
      const Tensor render = RenderLossOf(plain, batch, options_, step);
      losses.render = render.item<double>();
      losses.total = losses.total + options_.render_weight * render;
    }
    return losses;
  }

 private:
  const AutoencoderTrainOptions options_;
  const torch::Dtype compute_;
  const Tensor map_weights_;
  MapBatches pool_;
  const Tensor validation_maps_;
  AutoencoderNetwork network_, average_;
};

void Check(const AutoencoderTrainOptions& options) {
  CheckTrainOptions(options);
  if (options.smoothness < 0 || options.noise_variance < 0) {
    throw std::runtime_error(
        "training options: found a negative weight or variance; they must be 0 or more");
  }
}

}  // namespace

TrainProgress TrainAutoencoder(const AutoencoderTrainOptions& options, const TrainFiles& files,
                               const MaterialSource& materials, const MaterialSource& validation,
                               const TrainReport& report) {
  Check(options);
  torch::set_num_threads(options.threads);
  AutoencoderTraining training(options, FirstStep(files) * options.accumulate, materials,
                               validation);
  return RunTraining(options, files, &training, report);
}

}  // namespace glint
