#include "pipeline/studio/photographs/check_queue.h"

#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>
#include <utility>

#include "pipeline/files/files.h"
#include "pipeline/files/hash.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// Other for every change of the file.
std::string StampOf(const fs::path& file) {
  struct stat facts {};
  if (::stat(file.c_str(), &facts) != 0) return "missing";
  std::ostringstream text;
  text << facts.st_ino << ' ' << facts.st_size << ' ' << facts.st_mtim.tv_sec << ' '
       << facts.st_mtim.tv_nsec;
  return text.str();
}

std::string KeyOf(const fs::path& file, const CheckTask& task) {
  return file.string() + "\n" + StampOf(file) + "\n" + task.Key();
}

std::string PlainHash(const std::string& hash) { return hash.substr(hash.find(':') + 1); }

std::optional<PhotoCheck> ReadCheck(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream) return std::nullopt;
  return PhotoCheckFromJson(Json::parse(stream, nullptr, false));
}

// A result that cannot be kept is found again next time.
void KeepCheck(const fs::path& file, const fs::path& thumbnail, const PhotoCheck& check,
               const std::string& jpeg) {
  try {
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    if (!jpeg.empty()) WriteFileAtomically(thumbnail, jpeg);
    WriteFileAtomically(file, ToJson(check).dump());
  } catch (const std::exception&) {
  }
}

}  // namespace

CheckQueue::CheckQueue(int threads, std::function<void(const std::string&)> on_change)
    : on_change_(std::move(on_change)) {
  cv::setNumThreads(1);  // photographs are what is shared out
  for (int i = 0; i < std::max(threads, 1); ++i) threads_.emplace_back([this] { Work(); });
}

CheckQueue::~CheckQueue() { Stop(); }

void CheckQueue::Stop() {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    ending_ = true;
    arrived_.notify_all();
  }
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

CheckedPhoto CheckQueue::Peek(const fs::path& file, const CheckTask& task) {
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto found = known_.find(KeyOf(file, task));
  return found == known_.end() ? CheckedPhoto() : found->second;
}

CheckedPhoto CheckQueue::Look(const std::string& capture, const fs::path& file,
                              const CheckTask& task, const fs::path& cache) {
  const std::string key = KeyOf(file, task);
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto [found, is_new] = known_.try_emplace(key);
  if (is_new) {
    waiting_.push_back({key, capture, file, cache, task});
    arrived_.notify_one();
  }
  return found->second;
}

void CheckQueue::Work() {
  std::unique_lock<std::mutex> guard(mutex_);
  for (;;) {
    arrived_.wait(guard, [&] { return ending_ || !waiting_.empty(); });
    if (ending_) return;
    const Job job = waiting_.front();
    waiting_.pop_front();
    known_[job.key].state = CheckState::kChecking;
    guard.unlock();
    const CheckedPhoto checked = Check(job);
    guard.lock();
    known_[job.key] = checked;
    guard.unlock();
    on_change_(job.capture);
    guard.lock();
  }
}

CheckedPhoto CheckQueue::Check(const Job& job) const {
  CheckedPhoto checked;
  checked.state = CheckState::kDone;
  try {
    checked.content = PlainHash(HashFile(job.file));
  } catch (const std::exception& error) {
    PhotoCheck gone;
    gone.unreadable = error.what();
    checked.check = std::make_shared<PhotoCheck>(gone);
    return checked;
  }
  const std::string name = checked.content + "-" + PlainHash(job.task.Key());
  const fs::path file = job.cache / (name + ".json");
  checked.thumbnail = job.cache / (checked.content + ".jpg");
  if (auto kept = ReadCheck(file)) {
    checked.check = std::make_shared<PhotoCheck>(std::move(*kept));
  } else {
    std::string jpeg;
    checked.check = std::make_shared<PhotoCheck>(CheckPhoto(job.file, job.task, &jpeg));
    KeepCheck(file, checked.thumbnail, *checked.check, jpeg);
  }
  std::error_code error;
  if (!fs::is_regular_file(checked.thumbnail, error)) checked.thumbnail.clear();
  return checked;
}

}  // namespace glint
