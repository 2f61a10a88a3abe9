#include "fitting/training/map_batches.h"

#include <algorithm>
#include <stdexcept>

#include "fitting/encoding/encoding.h"
#include "fitting/training/random.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr int kValidationMaterials = 16;
constexpr std::uint64_t kCropStream = 0x5EED0005;

PoolOptions WithSeed(const TrainOptions& options) {
  PoolOptions pool = options.pool;
  pool.seed = options.seed;
  return pool;
}

std::span<float> Values(const Tensor& t) {
  return {t.data_ptr<float>(), static_cast<size_t>(t.numel())};
}

}  // namespace

BatchShape BatchShapeOf(const TrainOptions& options, std::int64_t step) {
  Stream random(StreamSeed(options.seed ^ kCropStream, static_cast<std::uint64_t>(step)));
  const int crop = options.crops[random.Below(static_cast<int>(options.crops.size()))];
  const double side = static_cast<double>(options.crops[0]) / crop;
  return {std::max(1, static_cast<int>(options.batch * side * side)), crop};
}

MapBatches::MapBatches(const TrainOptions& options, const MaterialSource& materials,
                       std::int64_t first_step, ShapeOf shape_of)
    : device_(options.device),
      shape_of_(shape_of ? std::move(shape_of)
                         : [options](std::int64_t step) { return BatchShapeOf(options, step); }),
      pool_(WithSeed(options), materials, first_step) {}

MapBatches::~MapBatches() {
  if (next_.valid()) next_.wait();
}

Tensor MapBatches::Cut(std::int64_t step) {
  const auto [count, crop] = shape_of_(step);
  const Tensor batch = torch::empty({count, kEncodedChannels, crop, crop});
  pool_.Sample(step, count, crop, Values(batch));
  return device_.is_cpu() ? batch : batch.pin_memory();
}

Tensor MapBatches::Sample(std::int64_t step) {
  const Tensor batch = next_.valid() && next_step_ == step ? next_.get() : Cut(step);
  next_step_ = step + 1;
  next_ = std::async(std::launch::async, [this, step] { return Cut(step + 1); });
  return batch.to(device_, /*non_blocking=*/true);
}

Tensor MapBatches::SampleFirst(int count, int crop) {
  const Tensor batch = torch::empty({count, kEncodedChannels, crop, crop});
  pool_.SampleFirst(count, crop, Values(batch));
  return batch;
}

Tensor ValidationMaps(const MaterialSource& source, int size) {
  const Tensor maps = torch::empty({kValidationMaterials, kEncodedChannels, size, size});
  for (int k = 0; k < kValidationMaterials; ++k) {
    const EncodedMaps encoded = EncodeMaps(source(static_cast<std::uint64_t>(k)));
    if (encoded.planes.size() != static_cast<size_t>(maps[k].numel())) {
      throw std::runtime_error("validation material of another size");
    }
    std::copy(encoded.planes.begin(), encoded.planes.end(), maps[k].data_ptr<float>());
  }
  return maps;
}

}  // namespace glint
