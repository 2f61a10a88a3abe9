// A progress bar on stderr, shown on a terminal only. Thread-safe. Under `glint run` it is the bar
// of the whole run (run_progress.h), and leaves no line behind.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "pipeline/contract/run_progress.h"

namespace glint {

class Progress {
 public:
  // What part of its stage's time the bar's steps take: from 0 to 1.
  struct Part {
    double begin = 0, end = 1;
  };
  // `total` steps; `label` is what is being done ("rectify").
  Progress(std::string label, std::int64_t total) : Progress(std::move(label), total, Part()) {}
  Progress(std::string label, std::int64_t total, Part part);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Advance(std::int64_t steps = 1, const std::string& note = "");
  void Set(std::int64_t done, const std::string& note = "");

 private:
  void Draw(bool force, const std::string& note);
  std::string Line(const std::string& note) const;

  std::string label_;
  std::int64_t total_;
  Part part_;
  std::optional<RunProgress> run_;
  std::atomic<std::int64_t> done_{0};
  bool terminal_;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point start_, last_draw_;
};

}  // namespace glint
