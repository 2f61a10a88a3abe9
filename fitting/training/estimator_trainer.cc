#include "fitting/training/estimator_trainer.h"

#include <stdexcept>

#include "fitting/estimator/estimator_file.h"
#include "fitting/training/map_training.h"
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

class EstimatorTraining : public MapTraining<EstimatorNetwork, EstimatorTrainOptions> {
 public:
  EstimatorTraining(const EstimatorTrainOptions& options, std::int64_t first_batch,
                    const MaterialSource& materials, const MaterialSource& validation)
      : MapTraining(options, first_batch, materials, validation, [&](MapBatches*) {
          return options.from.empty() ? EstimatorNetwork::Random(ChannelsOf(options), options.seed)
                                      : LoadEstimator(options.from);
        }) {}

  size_t learned() const override { return EstimatorNetwork(network_).State().size(); }
  std::map<std::string, std::string> Description() const override {
    return EstimatorMetadata(network_);
  }
  void SaveWeights(const std::filesystem::path& path,
                   std::map<std::string, std::string> metadata) override {
    SaveEstimator(path, &average_, std::move(metadata));
  }

  StepLosses Forward(std::int64_t step) override {
    const Tensor truth = pool_.Sample(step);
    Stream random(StreamSeed(options_.seed ^ kShotStream, static_cast<std::uint64_t>(step)));
    const PhotographBatch shown = PhotographMaps(truth, &random, false);
    const Tensor maps = network_.Forward(shown.features, shown.profiles, compute_);
    StepLosses losses;
    AddMapLoss(maps, truth, &losses);
    AddRenderLoss(maps, truth, step, &losses);
    return losses;
  }

 private:
  Tensor AveragedMaps(const Tensor& truth, std::int64_t number) override {
    Stream random(static_cast<std::uint64_t>(number));
    const PhotographBatch shown = PhotographMaps(truth, &random, true);
    return average_.Forward(shown.features, shown.profiles, compute_);
  }
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
