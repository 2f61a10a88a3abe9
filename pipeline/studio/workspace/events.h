// What has changed, for every open page: server-sent events.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

namespace glint {

class EventHub {
 public:
  // `what`: "library", "capture", "photograph" or "run"; `id`: which.
  void Publish(const std::string& what, const std::string& id);

  // The number from which a new page listens.
  std::uint64_t Now();
  // Waits for events after `*seen` about the capture `only` (empty: all), at most `patience_s`;
  // their text as the event stream has it, a comment where there were none. False: no more come.
  bool Next(std::uint64_t* seen, const std::string& only, double patience_s, std::string* text);

  void Close();

 private:
  struct Event {
    std::uint64_t number;
    std::string what, id;
  };
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Event> events_;  // the last ones
  std::uint64_t number_ = 0;
  bool closed_ = false;
};

}  // namespace glint
