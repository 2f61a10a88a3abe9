// Photographs are checked in the order in which they arrive, by a few threads; what was found stays
// on disk in the capture's working folder, by the photograph's content, so that a restart finds it.
#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/studio/photographs/photo_check.h"

namespace glint {

enum class CheckState { kWaiting, kChecking, kDone };

struct CheckedPhoto {
  CheckState state = CheckState::kWaiting;
  std::shared_ptr<const PhotoCheck> check;  // kDone
  std::string content;                      // hash of the file; kDone
  std::filesystem::path thumbnail;          // kDone; empty: there is none
};

struct SmallPicture {
  std::filesystem::path thumbnail;  // empty: there is none, or not yet
  std::string content;              // hash of the photograph
};

class CheckQueue {
 public:
  // `on_change` is called, by any thread, with the id of a capture of which a photograph's state
  // has changed.
  CheckQueue(int threads, std::function<void(const std::string& capture)> on_change);
  ~CheckQueue();
  CheckQueue(const CheckQueue&) = delete;
  CheckQueue& operator=(const CheckQueue&) = delete;

  // Photographs that wait are not checked any more; after this nothing is called back.
  void Stop();

  // What is known of the photograph, which is queued where nothing is. `cache` is the folder for
  // what is found; a file that changes is checked again.
  CheckedPhoto Look(const std::string& capture, const std::filesystem::path& file,
                    const CheckTask& task, const std::filesystem::path& cache);
  // The same without queueing anything.
  CheckedPhoto Peek(const std::filesystem::path& file, const CheckTask& task);

  // A photograph's thumbnail without its check, which takes a tenth of the time; made by one thread
  // while no photograph waits for its check.
  SmallPicture LookAtPicture(const std::string& capture, const std::filesystem::path& file,
                             const std::filesystem::path& cache);

 private:
  struct Job {
    std::string key, capture;
    std::filesystem::path file, cache;
    CheckTask task;
  };
  void Work();
  void CheckNext(std::unique_lock<std::mutex>* guard);
  void PictureNext(std::unique_lock<std::mutex>* guard);

  std::function<void(const std::string&)> on_change_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<Job> waiting_;
  std::map<std::string, CheckedPhoto> known_;  // by file, time, size and task
  std::deque<Job> pictures_waiting_;
  std::map<std::string, SmallPicture> pictures_;  // by file, time and size
  bool makes_picture_ = false;                    // some thread does
  bool ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace glint
