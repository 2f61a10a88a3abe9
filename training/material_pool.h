// Training samples: crops of a moving window over an endless sequence of materials.
//
// Threads of its own make materials ahead of use. Which materials step s sees, and which crops and
// changes of them, depends on the seed and s alone, so that a resumed training repeats.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "base/reflectance/svbrdf_maps.h"

namespace glint {

// Material k of the sequence.
using MaterialSource = std::function<SvbrdfMaps(std::uint64_t k)>;

struct PoolOptions {
  int material_size = 256;  // texels along a side of each material
  int window = 2048;        // materials a step chooses from, once that many exist
  int first = 64;           // materials made before step 0
  double per_step = 1.0;    // new materials per step
  int threads = 1;          // that make materials and cut crops
  std::uint64_t seed = 0;   // of choices and changes; the source has its own
};

class MaterialPool {
 public:
  // The first step will be `first_step` (0, or where training is resumed).
  MaterialPool(const PoolOptions& options, MaterialSource source, std::int64_t first_step);
  ~MaterialPool();
  MaterialPool(const MaterialPool&) = delete;
  MaterialPool& operator=(const MaterialPool&) = delete;

  // Fills `batch` [count, 9, crop, crop] (encoded maps). Steps must not decrease.
  void Sample(std::int64_t step, int count, int crop, std::span<float> batch);

  // The same from the first materials, before step 0; other crops than those of the steps.
  void SampleFirst(int count, int crop, std::span<float> batch);

 private:
  int lookahead() const;
  std::uint64_t Available(std::int64_t step) const;
  std::uint64_t Oldest(std::int64_t step) const;
  void Produce();
  void Fill(std::uint64_t begin, std::uint64_t end, std::uint64_t stream, int count, int crop,
            std::span<float> batch);

  PoolOptions options_;
  MaterialSource source_;
  std::vector<std::vector<std::int16_t>> slots_;  // encoded maps · 32767
  std::vector<std::uint64_t> numbers_;            // of the material in each slot, plus one
  std::uint64_t made_ = 0;                        // materials [.., made_) exist
  std::uint64_t begun_ = 0;                       // those below are made or being made
  std::uint64_t allowed_ = 0;                     // those below may be made
  bool stop_ = false;
  std::exception_ptr failure_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::thread> producers_;
};

}  // namespace glint
