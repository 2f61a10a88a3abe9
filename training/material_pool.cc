#include "training/material_pool.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/parallel/parallel.h"
#include "fitting/encoding/encoding.h"
#include "training/random.h"

namespace glint {
namespace {

constexpr int kLookahead = 16;  // materials made before they are needed, at least
constexpr int kMostInBatch = 4096;
constexpr float kScale = 32767.0f;

// One of the eight symmetries of the square, colour and roughness changes; drawn per sample.
struct Change {
  bool flip_x, flip_y, transpose;
  int row, column;
  int colour[3];  // which channel each of R, G, B is taken from
  float gain[6];  // of diffuse and specular, on √c
  float roughness_gain, roughness_offset;
  float slope_gain;  // on t: nearly proportional for small slopes
};

Change DrawChange(Stream* random, int size, int crop) {
  Change c{};
  c.flip_x = random->Below(2);
  c.flip_y = random->Below(2);
  c.transpose = random->Below(2);
  c.row = random->Below(size - crop + 1);
  c.column = random->Below(size - crop + 1);
  static constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                        {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  std::copy_n(kOrders[random->Uniform() < 0.5 ? 0 : random->Below(6)], 3, c.colour);
  const bool colours = random->Uniform() < 0.5, roughness = random->Uniform() < 0.5;
  const float all = static_cast<float>(random->Uniform(0.7, 1.2));
  for (int k = 0; k < 6; ++k) {
    const double tint = k < 3 ? random->Uniform(0.85, 1.15) : 1.0;
    c.gain[k] = colours ? static_cast<float>((k < 3 ? all : 1.0) * tint) : 1.0f;
  }
  c.roughness_gain = roughness ? static_cast<float>(random->Uniform(0.75, 1.25)) : 1.0f;
  c.roughness_offset = roughness ? static_cast<float>(random->Uniform(-0.15, 0.15)) : 0.0f;
  c.slope_gain = random->Uniform() < 0.5 ? static_cast<float>(random->Uniform(0.5, 1.3)) : 1.0f;
  return c;
}

// Where the texels of the changed crop lie in the material: first + row·by_row + column·by_column.
struct SourceTexels {
  std::ptrdiff_t first, by_row, by_column;
};

SourceTexels SourceTexelsOf(const Change& c, int size, int crop) {
  const std::ptrdiff_t down = c.flip_y ? -size : size, right = c.flip_x ? -1 : 1;
  const std::ptrdiff_t first =
      static_cast<std::ptrdiff_t>(c.row + (c.flip_y ? crop - 1 : 0)) * size + c.column +
      (c.flip_x ? crop - 1 : 0);
  return c.transpose ? SourceTexels{first, right, down} : SourceTexels{first, down, right};
}

// The plane that supplies encoded channel k, and the sign it takes. Rows run to −y: the transpose
// maps (x, y) to (−y, −x).
int SourcePlane(const Change& c, int k, float* sign) {
  *sign = 1.0f;
  if (k < 6) return k / 3 * 3 + c.colour[k % 3];
  if (k < kEncodedNormal) return k;
  const int axis = k - kEncodedNormal, from = c.transpose ? 1 - axis : axis;
  if (c.transpose) *sign = -*sign;
  if (from == 0 ? c.flip_x : c.flip_y) *sign = -*sign;
  return kEncodedNormal + from;
}

float ChangeValue(const Change& c, int k, float t) {
  if (k >= kEncodedNormal) return std::clamp(t * c.slope_gain, -1.0f, 1.0f);
  const float u = 0.5f * (t + 1.0f);
  const float changed = k < 6 ? u * c.gain[k] : u * c.roughness_gain + c.roughness_offset;
  return 2.0f * std::clamp(changed, 0.0f, 1.0f) - 1.0f;
}

void CutCrop(const std::vector<std::int16_t>& material, const Change& c, int size, int crop,
             float* out) {
  const SourceTexels source = SourceTexelsOf(c, size, crop);
  for (int k = 0; k < kEncodedChannels; ++k) {
    float sign;
    const std::int16_t* plane =
        material.data() + SourcePlane(c, k, &sign) * static_cast<size_t>(size) * size;
    for (int row = 0; row < crop; ++row) {
      const std::int16_t* from = plane + source.first + row * source.by_row;
      for (int column = 0; column < crop; ++column, from += source.by_column) {
        *out++ = ChangeValue(c, k, sign * *from / kScale);
      }
    }
  }
}

}  // namespace

MaterialPool::MaterialPool(const PoolOptions& options, MaterialSource source,
                           std::int64_t first_step)
    : options_(options), source_(std::move(source)) {
  if (options.window < 1 || options.first < 1 || options.per_step < 0 ||
      options.material_size < 1) {
    throw std::runtime_error("material pool: window, first and size must be at least 1");
  }
  slots_.resize(static_cast<size_t>(options.window) + lookahead());
  numbers_.resize(slots_.size());
  made_ = begun_ = allowed_ = Oldest(first_step);
  for (int i = 0; i < std::max(1, options.threads); ++i) {
    producers_.emplace_back([this] { Produce(); });
  }
}

MaterialPool::~MaterialPool() {
  {
    std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  for (std::thread& producer : producers_) producer.join();
}

int MaterialPool::lookahead() const { return std::max(kLookahead, 4 * options_.threads); }

std::uint64_t MaterialPool::Available(std::int64_t step) const {
  return static_cast<std::uint64_t>(options_.first) +
         static_cast<std::uint64_t>(static_cast<double>(step) * options_.per_step);
}

std::uint64_t MaterialPool::Oldest(std::int64_t step) const {
  const std::uint64_t end = Available(step), window = static_cast<std::uint64_t>(options_.window);
  return end > window ? end - window : 0;
}

void MaterialPool::Produce() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || begun_ < allowed_; });
    if (stop_) return;
    const std::uint64_t k = begun_++;
    lock.unlock();
    std::vector<std::int16_t> packed;
    std::exception_ptr failure;
    try {
      const EncodedMaps encoded = EncodeMaps(source_(k));
      const size_t side = static_cast<size_t>(options_.material_size);
      if (encoded.texels() != side * side) throw std::runtime_error("material of another size");
      packed.resize(encoded.planes.size());
      std::transform(encoded.planes.begin(), encoded.planes.end(), packed.begin(),
                     [](float t) { return static_cast<std::int16_t>(std::lround(t * kScale)); });
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    slots_[k % slots_.size()] = std::move(packed);
    numbers_[k % slots_.size()] = k + 1;
    while (numbers_[made_ % slots_.size()] == made_ + 1) ++made_;
    if (failure) {
      failure_ = failure;
      stop_ = true;
    }
    changed_.notify_all();
  }
}

void MaterialPool::Sample(std::int64_t step, int count, int crop, std::span<float> batch) {
  Fill(Oldest(step), Available(step), static_cast<std::uint64_t>(step) * kMostInBatch, count, crop,
       batch);
}

void MaterialPool::SampleFirst(int count, int crop, std::span<float> batch) {
  Fill(Oldest(0), Available(0), std::uint64_t{1} << 62, count, crop, batch);
}

void MaterialPool::Fill(std::uint64_t begin, std::uint64_t end, std::uint64_t stream, int count,
                        int crop, std::span<float> batch) {
  {
    std::unique_lock lock(mutex_);
    allowed_ = std::max(allowed_, end + static_cast<std::uint64_t>(lookahead()));
    changed_.notify_all();
    changed_.wait(lock, [&] { return failure_ || made_ >= end; });
    if (failure_) std::rethrow_exception(failure_);
  }
  const int size = options_.material_size;
  const size_t sample_values = static_cast<size_t>(kEncodedChannels) * crop * crop;
  if (crop < 1 || crop > size || count > kMostInBatch || batch.size() != sample_values * count) {
    throw std::runtime_error("material pool: crop larger than the materials, or a wrong batch");
  }
  ForEachPiece(count, std::max(1, options_.threads), [&](int i) {
    Stream random(StreamSeed(options_.seed, stream + static_cast<std::uint64_t>(i)));
    const std::uint64_t k = begin + random.Bits() % (end - begin);
    const Change change = DrawChange(&random, size, crop);
    CutCrop(slots_[k % slots_.size()], change, size, crop, batch.data() + i * sample_values);
  });
}

}  // namespace glint
