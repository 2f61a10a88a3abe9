#include "training/estimator_trainer.h"

#include <algorithm>
#include <stdexcept>

#include "fitting/estimator/estimator_file.h"
#include "fitting/layers/threads.h"
#include "training/map_training.h"
#include "training/training_photographs.h"

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

// Drawn weights, or the file's. A pooled network's file begins a descent too, whose first changes
// are none: the same function.
EstimatorNetwork FirstNetwork(const EstimatorTrainOptions& options) {
  const EstimatorKind wanted = ParseEstimatorKind(options.network);
  if (options.from.empty()) {
    return EstimatorNetwork::Random(ChannelsOf(options), options.seed, wanted);
  }
  EstimatorNetwork network = LoadEstimator(options.from);
  if (network.kind == EstimatorKind::kPooled && wanted == EstimatorKind::kDescent) {
    network.kind = wanted;
    network.descent = DescentNetwork::Random(options.seed);
  }
  if (network.kind != wanted) {
    throw std::runtime_error(options.from.string() + ": network: found " +
                             EstimatorKindName(network.kind) + " where " + options.network +
                             " is to be trained; give --network " +
                             EstimatorKindName(network.kind) + ", or no --from");
  }
  return network;
}

Stream ShotStream(const EstimatorTrainOptions& options, std::int64_t step) {
  return Stream(StreamSeed(options.seed ^ kShotStream, static_cast<std::uint64_t>(step)));
}

int DrawPhotographs(Stream* random) {
  return kPhotographCounts[random->Below(static_cast<int>(kPhotographCounts.size()))];
}

// Of `most` samples, so many that a step has no more photographs than it may.
int SamplesOf(const EstimatorTrainOptions& options, int most, int photographs) {
  const double share = static_cast<double>(options.batch_photographs) / options.batch / photographs;
  return std::clamp(static_cast<int>(share * most), 1, most);
}

BatchShape ShapeOf(const EstimatorTrainOptions& options, std::int64_t step) {
  BatchShape shape = BatchShapeOf(options, step);
  Stream random = ShotStream(options, step);
  shape.count = SamplesOf(options, shape.count, DrawPhotographs(&random));
  return shape;
}

class EstimatorTraining : public MapTraining<EstimatorNetwork, EstimatorTrainOptions> {
 public:
  EstimatorTraining(const EstimatorTrainOptions& options, std::int64_t first_batch,
                    const MaterialSource& materials, const MaterialSource& validation)
      : MapTraining(
            options, first_batch, materials, validation,
            [options](std::int64_t step) { return ShapeOf(options, step); },
            [&](MapBatches*) { return FirstNetwork(options); }) {}

  size_t learned() const override { return EstimatorNetwork(network_).State().size(); }
  std::map<std::string, std::string> Description() const override {
    return EstimatorMetadata(network_);
  }
  void SaveWeights(const std::filesystem::path& path, std::map<std::string, std::string> metadata,
                   bool bf16) override {
    SaveEstimator(path, &average_, std::move(metadata), bf16);
  }

  double samples_per_batch() const override {
    double sum = 0;
    for (const int photographs : kPhotographCounts) {
      sum += SamplesOf(options_, options_.batch, photographs);
    }
    return sum / kPhotographCounts.size();
  }

  StepLosses Forward(std::int64_t step) override {
    Stream random = ShotStream(options_, step);
    const int photographs = DrawPhotographs(&random);
    const Tensor truth = pool_.Sample(step);
    const CaptureBatch seen = PhotographMaps(truth, photographs, CaptureQuality::kDrawn, &random);
    const EstimatorOutput out =
        network_.Forward(seen.features, seen.profiles, seen.conditions, compute_);
    StepLosses losses;
    AddMapLoss(out.maps, truth, &losses);
    AddRenderLoss(out.maps, truth, step, &losses);
    const Tensor error = (out.maps - truth).abs().detach();
    Add(options_.spread_weight * (error * (-out.log_scale).exp() + out.log_scale).mean(), &losses);
    return losses;
  }

 private:
  // Half of the validation materials are seen once, the others five times.
  Tensor AveragedMaps(const Tensor& truth, std::int64_t number) override {
    Stream random(static_cast<std::uint64_t>(number));
    const CaptureBatch seen =
        PhotographMaps(truth, number % 2 == 0 ? 1 : 5, CaptureQuality::kClean, &random);
    return average_.Forward(seen.features, seen.profiles, seen.conditions, compute_).maps;
  }
};

}  // namespace

TrainProgress TrainEstimator(const EstimatorTrainOptions& options, const TrainFiles& files,
                             const MaterialSource& materials, const MaterialSource& validation,
                             const TrainReport& report) {
  CheckTrainOptions(options);
  UseThreads(options.threads);
  EstimatorTraining training(options, FirstBatch(options, files), materials, validation);
  return RunTraining(options, files, &training, report);
}

}  // namespace glint
