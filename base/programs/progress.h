// A progress bar on stderr, shown on a terminal only. Thread-safe. Under `glint run` it is the bar
// of the whole run (run_progress.h), and leaves no line behind.
//
// For other programs the same goes to the file that the environment variable GLINT_PROGRESS_FILE
// names, which must exist (a named pipe, say): a line of JSON at most ten times a second,
//   {"label": "refine", "share": 0.41, "remaining_s": 12.5, "note": ""}
// `share` is of the whole run under `glint run`, where it foresaw that the stage would run;
// `remaining_s` is null while it cannot be told. Lines that a full pipe has no room for are left
// out.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "base/programs/run_progress.h"

namespace glint {

inline constexpr char kProgressFileVariable[] = "GLINT_PROGRESS_FILE";

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
  // How far it is: of the whole run, where there is one.
  struct State {
    double share = 0;
    std::optional<double> remaining_s;
  };
  State Now() const;
  void Draw(bool force, const std::string& note);
  std::string Line(const State& state, const std::string& note) const;
  void WriteToFile(const State& state, const std::string& note) const;

  std::string label_;
  std::int64_t total_;
  Part part_;
  std::optional<RunProgress> run_;
  std::atomic<std::int64_t> done_{0};
  bool terminal_;
  int file_;  // descriptor of GLINT_PROGRESS_FILE; −1: none
  std::mutex mutex_;
  std::chrono::steady_clock::time_point start_, last_draw_;
};

}  // namespace glint
