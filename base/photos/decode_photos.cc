// Decodes photographs once, on all cores, and does nothing else: the least time that a run which
// reads them can take. What ./dev bench run states as the floor.
#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <thread>
#include <vector>

#include "base/parallel/parallel.h"
#include "base/photos/photo.h"

namespace glint {
namespace {

double ProcessorSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void DecodeAll(const std::vector<std::filesystem::path>& files) {
  const int count = static_cast<int>(files.size());
  const int threads = static_cast<int>(std::thread::hardware_concurrency());
  std::vector<std::size_t> pixels(files.size());
  const double processor_began_s = ProcessorSeconds();
  const auto began = std::chrono::steady_clock::now();
  ForEachPiece(count, threads, [&](int i) { pixels[i] = ReadPhoto(files[i]).image.pixels(); });
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - began;
  std::size_t all = 0;
  for (const std::size_t photo : pixels) all += photo;
  std::printf(
      "{\"photographs\": %d, \"pixels\": %zu, \"threads\": %d, \"seconds\": %.6f, "
      "\"processor_seconds\": %.6f}\n",
      count, all, threads, wall.count(), ProcessorSeconds() - processor_began_s);
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: decode_photos PHOTO…\n");
    return 2;
  }
  try {
    glint::DecodeAll({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "decode_photos: error: %s\n", error.what());
    return 2;
  }
  return 0;
}
