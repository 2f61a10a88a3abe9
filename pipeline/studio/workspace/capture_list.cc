#include "pipeline/studio/workspace/capture_list.h"

#include "pipeline/studio/http/http_types.h"

namespace glint {

std::vector<LibraryEntry> CaptureList::All(bool again) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kFresh = std::chrono::seconds(1);  // others make captures too
  const std::lock_guard<std::mutex> guard(mutex_);
  if (again || Clock::now() - listed_at_ > kFresh) {
    listed_ = FindCaptures(root_);
    listed_at_ = Clock::now();
  }
  return listed_;
}

LibraryEntry CaptureList::Find(const std::string& capture) {
  for (const bool again : {false, true}) {
    for (const LibraryEntry& entry : All(again)) {
      std::error_code error;
      if (entry.id == capture && std::filesystem::is_directory(entry.folder, error)) return entry;
    }
  }
  throw HttpError{404, "there is no such capture (any more)", "reload the page"};
}

std::shared_ptr<std::mutex> CaptureList::MutexOf(const std::string& capture) {
  const std::lock_guard<std::mutex> guard(mutex_);
  auto& mutex = changing_[capture];
  if (!mutex) mutex = std::make_shared<std::mutex>();
  return mutex;
}

}  // namespace glint
