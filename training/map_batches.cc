#include "training/map_batches.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "fitting/encoding/encoding.h"
#include "training/random.h"

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

BatchShape BatchShapeOf(const TrainOptions& options, std::int64_t batch) {
  Stream random(StreamSeed(options.seed ^ kCropStream, static_cast<std::uint64_t>(batch)));
  const int crop = options.crops[random.Below(static_cast<int>(options.crops.size()))];
  const double side = static_cast<double>(options.crops[0]) / crop;
  return {std::max(1, static_cast<int>(options.batch * side * side)), crop};
}

MapBatches::MapBatches(const TrainOptions& options, const MaterialSource& materials,
                       std::int64_t first_batch, ShapeOf shape_of)
    : device_(options.device),
      ahead_(static_cast<size_t>(std::max(1, options.batches_ahead))),
      shape_of_(shape_of ? std::move(shape_of)
                         : [options](std::int64_t batch) { return BatchShapeOf(options, batch); }),
      pool_(WithSeed(options), materials, first_batch) {}

MapBatches::~MapBatches() {
  {
    std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (cutter_.joinable()) cutter_.join();
}

void MapBatches::CutAhead(std::int64_t first) {
  for (std::int64_t batch = first;; ++batch) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || ready_.size() < ahead_; });
      if (stop_) return;
    }
    Tensor cut;
    std::exception_ptr failure;
    try {
      cut = Cut(batch);
    } catch (...) {
      failure = std::current_exception();
    }
    std::lock_guard lock(mutex_);
    ready_.push_back(std::move(cut));
    failure_ = failure;
    changed_.notify_all();
    if (failure) return;
  }
}

Tensor MapBatches::Cut(std::int64_t batch) {
  const auto [count, crop] = shape_of_(batch);
  const Tensor maps = torch::empty({count, kEncodedChannels, crop, crop},
                                   torch::TensorOptions().pinned_memory(device_.is_cuda()));
  pool_.Sample(batch, count, crop, Values(maps));
  return maps;
}

Tensor MapBatches::Sample(std::int64_t batch) {
  TORCH_CHECK(next_ < 0 || batch == next_, "batches: found number ", batch, " after ", next_ - 1);
  if (!cutter_.joinable()) cutter_ = std::thread([this, batch] { CutAhead(batch); });
  next_ = batch + 1;
  Tensor maps;
  {
    const auto began = std::chrono::steady_clock::now();
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !ready_.empty(); });
    maps = std::move(ready_.front());
    ready_.pop_front();
    if (!maps.defined()) std::rethrow_exception(failure_);
    waited_seconds_ +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  }
  changed_.notify_all();
  return maps.to(device_, /*non_blocking=*/true);
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
