#include "pipeline/studio/http/deadline_socket.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace glint {
namespace {

constexpr std::size_t kBuffer_bytes = 64 << 10;
constexpr double kLinger_s = 2;
constexpr std::uint64_t kLingerMost_bytes = 16u << 20;

}  // namespace

DeadlineSocket::DeadlineSocket(int descriptor, const DeadlineOptions& options)
    : descriptor_(descriptor), options_(options), begin_(Clock::now()) {}

DeadlineSocket::~DeadlineSocket() { ::close(descriptor_); }

double DeadlineSocket::Left_s() const {
  const double passed_s = std::chrono::duration<double>(Clock::now() - begin_).count();
  const double allowed_s =
      in_body_ ? options_.body_s + static_cast<double>(received_) / options_.bytes_per_s
               : options_.head_s;
  return std::min(allowed_s - passed_s, options_.silence_s);
}

bool DeadlineSocket::Wait(short events, double most_s) {
  if (most_s <= 0) return false;
  pollfd one{descriptor_, events, 0};
  int ready = 0;
  do {
    ready = ::poll(&one, 1, static_cast<int>(1000 * most_s) + 1);
  } while (ready < 0 && errno == EINTR);
  return ready > 0;
}

bool DeadlineSocket::Readable() { return at_ < buffer_.size() || Wait(POLLIN, Left_s()); }

// How long a reply takes is for the other side's reading to say: only silence ends it.
bool DeadlineSocket::Writable() { return Wait(POLLOUT, options_.silence_s); }

std::int64_t DeadlineSocket::Read(char* bytes, std::size_t most) {
  if (!in_body_ && delivered_ > options_.most_head_bytes) return -1;
  if (at_ == buffer_.size()) {
    if (!Wait(POLLIN, Left_s())) return -1;
    buffer_.resize(kBuffer_bytes);
    const ssize_t count = ::recv(descriptor_, buffer_.data(), buffer_.size(), 0);
    buffer_.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    at_ = 0;
    if (count <= 0) return count;
    received_ += static_cast<std::uint64_t>(count);
  }
  const std::size_t count = std::min(most, buffer_.size() - at_);
  std::memcpy(bytes, buffer_.data() + at_, count);
  at_ += count;
  delivered_ += count;
  return static_cast<std::int64_t>(count);
}

std::int64_t DeadlineSocket::Write(const char* bytes, std::size_t count) {
  if (!Writable()) return -1;
  return ::send(descriptor_, bytes, count, MSG_NOSIGNAL | MSG_DONTWAIT);
}

void DeadlineSocket::HeadIsRead() {
  in_body_ = true;
  begin_ = Clock::now();
}

void DeadlineSocket::Linger() {
  if (!in_body_) return;  // whoever could not send a head has no claim to more
  ::shutdown(descriptor_, SHUT_WR);
  const auto end = Clock::now() + std::chrono::duration<double>(kLinger_s);
  std::string unread(kBuffer_bytes, '\0');
  for (std::uint64_t total = 0; total < kLingerMost_bytes;) {
    const double left_s = std::chrono::duration<double>(end - Clock::now()).count();
    if (!Wait(POLLIN, left_s)) return;
    const ssize_t count = ::recv(descriptor_, unread.data(), unread.size(), MSG_DONTWAIT);
    if (count <= 0) return;
    total += static_cast<std::uint64_t>(count);
  }
}

}  // namespace glint
