#include "fitting/render/tiles.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace glint {
namespace {

// Hands out tiles until none is left or one has failed.
class TileQueue {
 public:
  TileQueue(int tiles, const std::function<void(int)>& task) : tiles_(tiles), task_(task) {}

  void Drain() {
    try {
      for (int tile = next_++; tile < tiles_ && !failed_; tile = next_++) task_(tile);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      failed_ = true;
    }
  }

  void Rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  const int tiles_;
  const std::function<void(int)>& task_;
  std::atomic<int> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace

void RunTiles(int tiles, int threads, const std::function<void(int tile)>& task) {
  if (threads <= 0) threads = static_cast<int>(std::thread::hardware_concurrency());
  threads = std::clamp(threads, 1, std::max(tiles, 1));
  TileQueue queue(tiles, task);
  std::vector<std::thread> helpers;
  helpers.reserve(threads - 1);
  for (int i = 1; i < threads; ++i) {
    try {
      helpers.emplace_back([&queue] { queue.Drain(); });
    } catch (const std::system_error&) {
      break;  // the system gives no more threads: those that run do the work
    }
  }
  queue.Drain();
  for (std::thread& helper : helpers) helper.join();
  queue.Rethrow();
}

}  // namespace glint
