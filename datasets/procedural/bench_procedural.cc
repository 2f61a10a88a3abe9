// Maps per second of the procedural generator at 256², blends included, as training draws them,
// against the goal of 200 a second on two cores; then the families, slowest first.
// One thread is timed by its own processor time, so that other work on the machine counts little;
// all threads are timed by the clock.
#include <time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "base/parallel/parallel.h"
#include "datasets/procedural/material.h"

namespace glint {
namespace {

constexpr int kSize = 256;
constexpr double kGoalPerSecond = 200;
constexpr double kGoalCores = 2;
constexpr int kSeedsOfFamily = 12;

double ThreadSeconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Keeps the compiler from leaving work out.
std::atomic<float> sink{0};
void Make(uint64_t seed) { sink = MakeMaterial(seed, kSize, kSize).planes[0]; }

double SecondsOfOneThread(int maps) {
  const double start = ThreadSeconds();
  for (int seed = 0; seed < maps; ++seed) Make(static_cast<uint64_t>(seed));
  return ThreadSeconds() - start;
}

double SecondsOfAll(int maps, int threads) {
  const auto start = std::chrono::steady_clock::now();
  ForEachPiece(maps, threads, [](int seed) { Make(static_cast<uint64_t>(seed)); });
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void PrintFamilies() {
  std::vector<std::pair<double, std::string>> times;
  for (const std::string& family : MaterialFamilies()) {
    const double start = ThreadSeconds();
    for (int seed = 0; seed < kSeedsOfFamily; ++seed) {
      sink = MakeMaterial(family, static_cast<uint64_t>(seed), kSize, kSize).planes[0];
    }
    times.emplace_back((ThreadSeconds() - start) / kSeedsOfFamily, family);
  }
  std::sort(times.rbegin(), times.rend());
  for (const auto& [seconds, family] : times) {
    std::printf("  %-16s %6.2f ms\n", family.c_str(), 1e3 * seconds);
  }
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  const int maps = argc > 1 ? std::max(std::atoi(argv[1]), 1) : 400;
  const int threads = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1u));
  const double one = maps / glint::SecondsOfOneThread(maps);
  const double goal = glint::kGoalPerSecond / glint::kGoalCores;
  std::printf(
      "%d maps of 256²: %.1f per second on one core (%.2f ms each); goal %.0f: ratio %.2f\n", maps,
      one, 1e3 / one, goal, one / goal);
  const double all = maps / glint::SecondsOfAll(maps, threads);
  std::printf("%d threads, wall time: %.1f per second (%.1f per thread)\n", threads, all,
              all / threads);
  std::printf("families, unblended:\n");
  glint::PrintFamilies();
  return 0;
}
