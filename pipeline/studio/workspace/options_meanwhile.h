// The form of options, which takes seconds to make, made before a page asks for it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "base/files/json.h"

namespace glint {

class OptionsMeanwhile {
 public:
  ~OptionsMeanwhile() { Stop(); }

  // Begins a little later, by a thread of its own; once.
  void Prepare();
  // Waits for it.
  const Json& Form();
  void Stop();

 private:
  std::once_flag made_;
  Json form_;
  std::thread preparing_;
  std::mutex mutex_;
  std::atomic<bool> ending_ = false;
  std::condition_variable end_;
};

}  // namespace glint
