// A progress bar on stderr, shown on a terminal only. Thread-safe.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

namespace glint {

class Progress {
 public:
  // `total` steps; `label` is what is being done ("rectify").
  Progress(std::string label, std::int64_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Advance(std::int64_t steps = 1, const std::string& note = "");
  void Set(std::int64_t done, const std::string& note = "");

 private:
  void Draw(bool force, const std::string& note);

  std::string label_;
  std::int64_t total_;
  std::atomic<std::int64_t> done_{0};
  bool terminal_;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point start_, last_draw_;
};

}  // namespace glint
