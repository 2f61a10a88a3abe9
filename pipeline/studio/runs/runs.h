// Runs: `glint run` as a child process for each capture, watched by a thread of its own.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/files/json.h"

namespace glint {

struct RunStage {
  std::string name;
  std::string state = "waiting";  // "running", "done", "up to date", "failed"
  std::optional<double> share;    // of the stage
};

struct RunView {
  std::string state = "running";  // "done", "failed", "cancelled"
  bool quick = false;
  std::vector<RunStage> stages;
  double share = 0;  // of the whole run
  std::optional<double> remaining_s;
  std::string message, remedy;  // of a failed run
};
Json ToJson(const RunView& view);

class RunManager {
 public:
  // `on_change` is called with the capture's id while a run goes on and when it ends.
  explicit RunManager(std::function<void(const std::string& capture)> on_change);
  ~RunManager();  // cancels what runs, and waits for it
  RunManager(const RunManager&) = delete;
  RunManager& operator=(const RunManager&) = delete;

  // Throws HttpError 409 where the capture's run goes on, UserError for a capture that cannot be
  // read.
  void Start(const std::string& capture, const std::filesystem::path& folder, bool quick);
  void Cancel(const std::string& capture);
  bool IsRunning(const std::string& capture);
  // The run that goes on, or the last one, also of an earlier Studio.
  std::optional<RunView> Look(const std::string& capture, const std::filesystem::path& folder);

 private:
  struct Run;
  void Watch(Run* run);
  int RunProgram(Run* run, const std::filesystem::path& log, std::string* failure);
  void UpdateProgress(Run* run);

  std::function<void(const std::string&)> on_change_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Run>> runs_;
};

// Whether a `glint run` of anybody's goes on in the capture.
bool RunsElsewhere(const std::filesystem::path& capture);

}  // namespace glint
