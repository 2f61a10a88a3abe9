// A connection that ends when its other side is too slow, so that slow and stuck clients hold
// nothing for long.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace glint {

struct DeadlineOptions {
  double head_s = 10;         // for request line and headers together
  double body_s = 30;         // for a body, and one second more for each `bytes_per_s` received
  double bytes_per_s = 4096;  // a phone at the edge of its network sends ten times that
  double silence_s = 15;      // without a byte in either direction
  std::size_t most_head_bytes = 64 << 10;
};

class DeadlineSocket {
 public:
  // Takes the descriptor over and closes it in the end.
  explicit DeadlineSocket(int descriptor, const DeadlineOptions& options = {});
  ~DeadlineSocket();
  DeadlineSocket(const DeadlineSocket&) = delete;
  DeadlineSocket& operator=(const DeadlineSocket&) = delete;

  // As read(2): 0 at the end, −1 for an error or a passed deadline.
  std::int64_t Read(char* bytes, std::size_t most);
  std::int64_t Write(const char* bytes, std::size_t count);
  bool Readable();  // within the deadline
  bool Writable();

  void HeadIsRead();  // from now on the body's deadline holds
  // Lets the other side read the reply although it still sends: closing at once would reset the
  // connection, and a browser then shows no reply at all.
  void Linger();
  int descriptor() const { return descriptor_; }

 private:
  using Clock = std::chrono::steady_clock;
  double Left_s() const;
  bool Wait(short events, double most_s);

  int descriptor_;
  DeadlineOptions options_;
  Clock::time_point begin_;
  bool in_body_ = false;
  std::uint64_t received_ = 0;
  std::size_t delivered_ = 0;
  std::string buffer_;  // received and not yet asked for, from `at_`
  std::size_t at_ = 0;
};

}  // namespace glint
