#include "base/parallel/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace glint {
namespace {

TEST(ForEachPiece, CallsEveryPieceOnceWithAnyNumberOfThreads) {
  for (const int threads : {0, 1, 2, 7, 100}) {
    std::vector<std::atomic<int>> runs(50);
    ForEachPiece(50, threads, [&](int piece) { ++runs[piece]; });
    for (const auto& count : runs) EXPECT_EQ(count, 1) << threads;
  }
  ForEachPiece(0, 4, [](int) { FAIL() << "no piece to run"; });
}

TEST(ForEachPiece, RethrowsTheFailureOfTheLowestPieceHoweverThreadsRace) {
  for (const int threads : {1, 2, 7}) {
    for (int attempt = 0; attempt < 20; ++attempt) {
      std::string said;
      try {
        ForEachPiece(50, threads, [](int piece) {
          if (piece < 20) return;
          if (piece == 20) std::this_thread::sleep_for(std::chrono::milliseconds(1));
          throw std::runtime_error(std::to_string(piece));
        });
      } catch (const std::runtime_error& error) {
        said = error.what();
      }
      EXPECT_EQ(said, "20") << threads;
    }
  }
}

TEST(ForEachPiece, BeginsNoFurtherPieceAfterAFailure) {
  int runs = 0;
  EXPECT_THROW(ForEachPiece(50, 1,
                            [&](int piece) {
                              ++runs;
                              if (piece == 3) throw std::runtime_error("three");
                            }),
               std::runtime_error);
  EXPECT_EQ(runs, 4);
}

TEST(ForEachPieceByWorker, NoTwoThreadsAreTheSameWorkerAtOnce) {
  constexpr int kThreads = 3;
  std::vector<std::atomic<int>> busy(kThreads);
  std::atomic<bool> shared{false};
  ForEachPieceByWorker(200, kThreads, [&](int, int worker) {
    if (worker < 0 || worker >= kThreads || ++busy[worker] != 1) {
      shared = true;
      return;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(20));
    --busy[worker];
  });
  EXPECT_FALSE(shared);
}

TEST(ForEachBlock, CoversTheRangeWithoutOverlap) {
  for (const int count : {0, 1, 7, 8, 9, 23}) {
    std::vector<std::atomic<int>> runs(count);
    ForEachBlock(count, 8, 2, [&](int begin, int end) {
      EXPECT_EQ(begin % 8, 0);
      EXPECT_LT(begin, end);
      EXPECT_LE(end - begin, 8);
      for (int i = begin; i < end; ++i) ++runs[i];
    });
    for (const auto& n : runs) EXPECT_EQ(n, 1) << count;
  }
}

}  // namespace
}  // namespace glint
