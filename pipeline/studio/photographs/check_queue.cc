#include "pipeline/studio/photographs/check_queue.h"

#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>
#include <utility>

#include "base/files/files.h"
#include "base/files/hash.h"
#include "pipeline/studio/photographs/thumbnail.h"

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

fs::path ThumbnailIn(const fs::path& cache, const std::string& content) {
  return cache / (content + ".jpg");
}

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

// What was kept of the photograph, or what is found now and kept.
CheckedPhoto FindCheck(const fs::path& photo, const fs::path& cache, const CheckTask& task) {
  CheckedPhoto checked;
  checked.state = CheckState::kDone;
  try {
    checked.content = PlainHash(HashFile(photo));
  } catch (const std::exception& error) {
    PhotoCheck gone;
    gone.unreadable = error.what();
    checked.check = std::make_shared<PhotoCheck>(gone);
    return checked;
  }
  const fs::path file = cache / (checked.content + "-" + PlainHash(task.Key()) + ".json");
  checked.thumbnail = ThumbnailIn(cache, checked.content);
  if (auto kept = ReadCheck(file)) {
    checked.check = std::make_shared<PhotoCheck>(std::move(*kept));
  } else {
    std::string jpeg;
    checked.check = std::make_shared<PhotoCheck>(CheckPhoto(photo, task, &jpeg));
    KeepCheck(file, checked.thumbnail, *checked.check, jpeg);
  }
  std::error_code error;
  if (!fs::is_regular_file(checked.thumbnail, error)) checked.thumbnail.clear();
  return checked;
}

SmallPicture FindPicture(const fs::path& photo, const fs::path& cache) {
  try {
    const std::string content = PlainHash(HashFile(photo));
    const fs::path thumbnail = ThumbnailIn(cache, content);
    std::error_code error;
    if (!fs::is_regular_file(thumbnail, error)) {
      const std::string jpeg = SmallJpegOf(photo);
      fs::create_directories(cache, error);
      WriteFileAtomically(thumbnail, jpeg);
    }
    return {thumbnail, content};
  } catch (const std::exception&) {  // its check will say what is wrong with it
    return {};
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

SmallPicture CheckQueue::LookAtPicture(const std::string& capture, const fs::path& file,
                                       const fs::path& cache) {
  const std::string key = file.string() + "\n" + StampOf(file);
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto [found, is_new] = pictures_.try_emplace(key);
  if (is_new) {
    pictures_waiting_.push_back({key, capture, file, cache, {}});
    arrived_.notify_one();
  }
  return found->second;
}

void CheckQueue::Work() {
  std::unique_lock<std::mutex> guard(mutex_);
  const auto has_picture = [&] { return !makes_picture_ && !pictures_waiting_.empty(); };
  for (;;) {
    arrived_.wait(guard, [&] { return ending_ || !waiting_.empty() || has_picture(); });
    if (ending_) return;
    if (!waiting_.empty()) {
      CheckNext(&guard);
    } else {
      PictureNext(&guard);
    }
  }
}

void CheckQueue::CheckNext(std::unique_lock<std::mutex>* guard) {
  const Job job = waiting_.front();
  waiting_.pop_front();
  known_[job.key].state = CheckState::kChecking;
  guard->unlock();
  const CheckedPhoto checked = FindCheck(job.file, job.cache, job.task);
  guard->lock();
  known_[job.key] = checked;
  guard->unlock();
  on_change_(job.capture);
  guard->lock();
}

void CheckQueue::PictureNext(std::unique_lock<std::mutex>* guard) {
  const Job job = pictures_waiting_.front();
  pictures_waiting_.pop_front();
  makes_picture_ = true;
  guard->unlock();
  const SmallPicture picture = FindPicture(job.file, job.cache);
  guard->lock();
  pictures_[job.key] = picture;
  makes_picture_ = false;
  guard->unlock();
  if (!picture.thumbnail.empty()) on_change_(job.capture);
  guard->lock();
}

}  // namespace glint
