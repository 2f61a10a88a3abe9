#include "base/parallel/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace glint {
namespace {

// Hands out pieces until none is left or one has failed.
class PieceQueue {
 public:
  PieceQueue(int pieces, const std::function<void(int, int)>& work)
      : pieces_(pieces), work_(work) {}

  void Drain(int worker) {
    while (!failed_) {
      const int piece = next_++;
      if (piece >= pieces_) return;
      try {
        work_(piece, worker);
      } catch (...) {
        Fail(piece, std::current_exception());
      }
    }
  }

  void Rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  // The pieces below one that failed were all handed out before it, and what is handed out is done:
  // so the lowest piece that fails is the same in every run.
  void Fail(int piece, std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    if (!error_ || piece < failed_piece_) {
      error_ = std::move(error);
      failed_piece_ = piece;
    }
    failed_ = true;
  }

  const int pieces_;
  const std::function<void(int, int)>& work_;
  std::atomic<int> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
  int failed_piece_ = 0;
};

}  // namespace

void ForEachPieceByWorker(int pieces, int threads, const std::function<void(int, int)>& work) {
  if (threads <= 0) threads = static_cast<int>(std::thread::hardware_concurrency());
  threads = std::clamp(threads, 1, std::max(pieces, 1));
  PieceQueue queue(pieces, work);
  std::vector<std::thread> helpers;
  helpers.reserve(static_cast<size_t>(threads - 1));
  for (int worker = 1; worker < threads; ++worker) {
    try {
      helpers.emplace_back([&queue, worker] { queue.Drain(worker); });
    } catch (const std::system_error&) {
      break;  // the system gives no more threads: those that run do the work
    }
  }
  queue.Drain(0);
  for (std::thread& helper : helpers) helper.join();
  queue.Rethrow();
}

void ForEachPiece(int pieces, int threads, const std::function<void(int)>& work) {
  ForEachPieceByWorker(pieces, threads, [&work](int piece, int) { work(piece); });
}

void ForEachBlock(int count, int block, int threads, const std::function<void(int, int)>& work) {
  const int blocks = count / block + (count % block != 0);
  ForEachPiece(blocks, threads, [&](int piece) {
    const int begin = piece * block;
    work(begin, std::min(block, count - begin) + begin);
  });
}

}  // namespace glint
