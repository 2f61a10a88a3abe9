// What all trainings share: steps of Adam under a learning-rate schedule, a moving average of the
// weights, checkpoints that resume to the same bits, validation, the log. Include from .cc files
// only: this header pulls in torch.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "fitting/weights/tensor_records.h"
#include "training/train_options.h"

namespace glint {

struct StepLosses {
  torch::Tensor total;                    // what is minimised
  torch::Tensor map, smoothness, render;  // for the log; undefined: not part of it
};

// A network to be trained, with its data and losses.
class Trainable {
 public:
  virtual ~Trainable() = default;
  // Learned tensors first (as many as `learned()`), then the others that weights files hold. The
  // moving average's are in the same order.
  virtual NamedTensors State() = 0;
  virtual NamedTensors AverageState() = 0;
  virtual size_t learned() const = 0;
  // Losses of batch number `batch`, which depends on the options and `batch` alone. Numbers rise.
  virtual StepLosses Forward(std::int64_t batch) = 0;
  // Crops in a batch, in the mean.
  virtual double samples_per_batch() const = 0;
  // How long Forward() has waited for batches, in all.
  virtual double waited_seconds() const = 0;
  // L1 of encoded maps on materials that are never trained on, by the averaged weights.
  virtual double Validate() = 0;
  // What kind of network this is; a checkpoint of another is refused.
  virtual std::map<std::string, std::string> Description() const = 0;
  // Writes the averaged weights, in bf16 or float32.
  virtual void SaveWeights(const std::filesystem::path& path,
                           std::map<std::string, std::string> metadata, bool bf16) = 0;
};

// Throws std::runtime_error for options that cannot be.
void CheckTrainOptions(const TrainOptions& options);

// Trains from the weights as they are, or from the checkpoint. Throws std::runtime_error for files
// that cannot be read or written. Returns the last progress.
TrainProgress RunTraining(const TrainOptions& options, const TrainFiles& files,
                          Trainable* trainable, const TrainReport& report);

// The batch that training begins with: 0, or the checkpoint's. (Data may have to be made up to it.)
std::int64_t FirstBatch(const TrainOptions& options, const TrainFiles& files);

}  // namespace glint
