#include "fitting/training/map_batches.h"

#include <algorithm>
#include <stdexcept>

#include "fitting/encoding/encoding.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr int kValidationMaterials = 16;

PoolOptions WithSeed(const TrainOptions& options) {
  PoolOptions pool = options.pool;
  pool.seed = options.seed;
  return pool;
}

std::span<float> Values(const Tensor& t) {
  return {t.data_ptr<float>(), static_cast<size_t>(t.numel())};
}

}  // namespace

MapBatches::MapBatches(const TrainOptions& options, const MaterialSource& materials,
                       std::int64_t first_step)
    : batch_(options.batch), crop_(options.crop), pool_(WithSeed(options), materials, first_step) {}

Tensor MapBatches::Sample(std::int64_t step) {
  const Tensor batch = torch::empty({batch_, kEncodedChannels, crop_, crop_});
  pool_.Sample(step, batch_, crop_, Values(batch));
  return batch;
}

Tensor MapBatches::SampleFirst(int count) {
  const Tensor batch = torch::empty({count, kEncodedChannels, crop_, crop_});
  pool_.SampleFirst(count, crop_, Values(batch));
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
