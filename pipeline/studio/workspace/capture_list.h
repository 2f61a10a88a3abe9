// The captures beneath the folder, looked for again when a second has passed.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/studio/captures/library.h"

namespace glint {

class CaptureList {
 public:
  explicit CaptureList(std::filesystem::path root) : root_(std::move(root)) {}

  // `again`: now, since it is known that there is another.
  std::vector<LibraryEntry> All(bool again = false);
  // Throws HttpError 404.
  LibraryEntry Find(const std::string& capture);
  // Held by whoever changes the capture.
  std::shared_ptr<std::mutex> MutexOf(const std::string& capture);

 private:
  std::filesystem::path root_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<std::mutex>> changing_;  // by capture
  std::vector<LibraryEntry> listed_;
  std::chrono::steady_clock::time_point listed_at_;
};

}  // namespace glint
