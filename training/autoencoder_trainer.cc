#include "training/autoencoder_trainer.h"

#include <cmath>
#include <stdexcept>

#include "fitting/autoencoder/network_file.h"
#include "fitting/layers/threads.h"
#include "training/map_training.h"
#include "training/principal_start.h"
#include "training/random.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr double kBatchStatisticsMomentum = 0.005;
constexpr std::uint64_t kNoiseStream = 0x5EED0001;
constexpr int kFirstSamples = 192;

// Lets the running statistics of drawn weights begin at those of real crops: trainings normalise by
// them, and a code of another scale drowns in the noise of the smoothness term.
void MeasureStatistics(const Tensor& samples, AutoencoderNetwork* network) {
  torch::NoGradGuard no_gradient;
  constexpr double kAllNew = 1.0;
  network->EncodeForTraining(samples, torch::kFloat32, kAllNew);
  const Tensor z = network->EncodeForTraining(samples, torch::kFloat32, kAllNew);
  network->DecodeForTraining(z, torch::kFloat32, kAllNew);
}

AutoencoderNetwork FirstWeights(const AutoencoderTrainOptions& options, std::int64_t first_batch,
                                MapBatches* pool) {
  if (!options.from.empty()) return LoadNetwork(options.from);
  const Normalisation normalisation = ParseNormalisation(options.normalisation);
  const bool principal = options.principal_start && normalisation != Normalisation::kAll;
  if (first_batch == 0 && principal) {
    return StartFromPrincipalComponents(
        options.channels, pool->SampleFirst(kFirstSamples, options.crops[0]), normalisation);
  }
  AutoencoderNetwork drawn =
      AutoencoderNetwork::Random(options.channels, options.seed, normalisation);
  if (first_batch == 0)
    MeasureStatistics(pool->SampleFirst(kFirstSamples, options.crops[0]), &drawn);
  return drawn;
}

class AutoencoderTraining : public MapTraining<AutoencoderNetwork, AutoencoderTrainOptions> {
 public:
  AutoencoderTraining(const AutoencoderTrainOptions& options, std::int64_t first_batch,
                      const MaterialSource& materials, const MaterialSource& validation)
      : MapTraining(options, first_batch, materials, validation, {},
                    [&](MapBatches* pool) { return FirstWeights(options, first_batch, pool); }) {}

  size_t learned() const override { return AutoencoderNetwork(network_).Parameters().size(); }
  std::map<std::string, std::string> Description() const override {
    return NetworkMetadata(network_);
  }
  void SaveWeights(const std::filesystem::path& path, std::map<std::string, std::string> metadata,
                   bool bf16) override {
    SaveNetwork(path, &average_, std::move(metadata), bf16);
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
          torch::randn(part.sizes(), generator).to(device_) * std::sqrt(options_.noise_variance);
      codes = torch::cat({z, part + noise}, 0);
    }
    const Tensor decoded = network_.DecodeForTraining(codes, compute_, kBatchStatisticsMomentum);
    const Tensor plain = decoded.slice(0, 0, count);
    AddMapLoss(plain, batch, &losses);
    if (twice > 0) {
      const Tensor moved = decoded.slice(0, count, count + twice) - decoded.slice(0, 0, twice);
      const Tensor smoothness = WeightedL1(moved);
      losses.smoothness = smoothness.detach();
      Add(options_.smoothness * smoothness, &losses);
    }
    AddRenderLoss(plain, batch, step, &losses);
    return losses;
  }

 private:
  Tensor AveragedMaps(const Tensor& truth, std::int64_t) override {
    const Tensor z = average_.NormaliseByRunning(average_.EncodeRaw(truth, compute_));
    return average_.Decode(z, compute_);
  }
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
  UseThreads(options.threads);
  AutoencoderTraining training(options, FirstBatch(options, files), materials, validation);
  return RunTraining(options, files, &training, report);
}

}  // namespace glint
