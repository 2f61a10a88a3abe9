#include "pipeline/studio/workspace/events.h"

#include <chrono>

#include "base/files/json.h"

namespace glint {
namespace {

constexpr size_t kMostEvents = 1000;  // a page that missed more reads everything anyway

}  // namespace

void EventHub::Publish(const std::string& what, const std::string& id) {
  const std::lock_guard<std::mutex> guard(mutex_);
  events_.push_back({++number_, what, id});
  if (events_.size() > kMostEvents) events_.pop_front();
  changed_.notify_all();
}

std::uint64_t EventHub::Now() {
  const std::lock_guard<std::mutex> guard(mutex_);
  return number_;
}

bool EventHub::Next(std::uint64_t* seen, const std::string& only, double patience_s,
                    std::string* text) {
  std::unique_lock<std::mutex> guard(mutex_);
  const auto collect = [&] {
    std::string last;
    for (const Event& event : events_) {
      if (event.number <= *seen) continue;
      if (!only.empty() && event.id != only) continue;
      const Json json = {{"what", event.what}, {"id", event.id}};
      const std::string one = "event: change\ndata: " + json.dump() + "\n\n";
      if (one != last) *text += one;
      last = one;
    }
    *seen = number_;
    return !text->empty();
  };
  changed_.wait_for(guard, std::chrono::duration<double>(patience_s),
                    [&] { return closed_ || collect(); });
  if (text->empty()) *text = ":\n\n";
  return !closed_;
}

void EventHub::Close() {
  const std::lock_guard<std::mutex> guard(mutex_);
  closed_ = true;
  changed_.notify_all();
}

}  // namespace glint
