// A client that sends any bytes, well-formed or not.
#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/files/json.h"

namespace glint::test {

// Whether a connection that a signal interrupted on its way is there now.
inline bool IsConnected(int socket) {
  pollfd wait{socket, POLLOUT, 0};
  int ready = 0;
  do {
    ready = ::poll(&wait, 1, -1);
  } while (ready < 0 && errno == EINTR);
  int error = 0;
  socklen_t size = sizeof error;
  return ready > 0 && ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0;
}

// Waits where all ports of this machine are those of connections that have just ended. −1: nobody
// listens.
inline int Connect(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  ::inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0)
      return socket;
    const int error = errno;
    if (error == EINTR && IsConnected(socket)) return socket;
    ::close(socket);
    errno = error;
    if (error != EADDRNOTAVAIL) return -1;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return -1;
}

inline bool SendAll(int socket, const std::string& bytes) {
  for (size_t at = 0; at < bytes.size();) {
    const ssize_t count = ::send(socket, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += static_cast<size_t>(count);
  }
  return true;
}

// Whether there is something to read, or the other side has closed, within `patience_s`.
inline bool IsReadable(int socket, double patience_s) {
  pollfd wait{socket, POLLIN, 0};
  int ready = 0;
  do {
    ready = ::poll(&wait, 1, static_cast<int>(1000 * patience_s));
  } while (ready < 0 && errno == EINTR);
  return ready > 0;
}

// Until the other side closes, or is silent for `patience_s`.
inline std::string ReceiveAll(int socket, double patience_s = 20) {
  std::string all;
  char bytes[65536];
  for (;;) {
    if (!IsReadable(socket, patience_s)) return all;
    const ssize_t count = ::recv(socket, bytes, sizeof bytes, 0);
    if (count <= 0) return all;
    all.append(bytes, static_cast<size_t>(count));
  }
}

struct Answer {
  int status = 0;
  std::string head, body;
  Json json() const { return Json::parse(body, nullptr, false); }
};

inline Answer Parsed(const std::string& bytes) {
  Answer answer;
  const size_t end = bytes.find("\r\n\r\n");
  if (bytes.size() < 12 || end == std::string::npos) return answer;
  answer.status = std::atoi(bytes.substr(9, 3).c_str());
  answer.head = bytes.substr(0, end + 2);
  answer.body = bytes.substr(end + 4);
  return answer;
}

using Headers = std::vector<std::pair<std::string, std::string>>;

inline std::string RequestText(const std::string& method, const std::string& path,
                               const Headers& headers, const std::string& body = "") {
  std::string text = method + " " + path + " HTTP/1.1\r\n";
  for (const auto& [name, value] : headers) text.append(name).append(": ").append(value + "\r\n");
  if (!body.empty() || method == "POST" || method == "PUT") {
    text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  }
  return text + "\r\n" + body;
}

inline Answer Ask(int port, const std::string& bytes) {
  const int socket = Connect(port);
  if (socket < 0) return {};
  SendAll(socket, bytes);
  const std::string reply = ReceiveAll(socket);
  ::close(socket);
  return Parsed(reply);
}

// As Studio's own page asks.
class PageClient {
 public:
  // `address`: "http://127.0.0.1:PORT/?t=TOKEN"
  explicit PageClient(const std::string& address) {
    const size_t colon = address.rfind(':');
    port_ = std::atoi(address.c_str() + colon + 1);
    token_ = address.substr(address.find("?t=") + 3);
  }

  int port() const { return port_; }
  const std::string& token() const { return token_; }
  std::string host() const { return "127.0.0.1:" + std::to_string(port_); }
  std::string cookie() const { return "glint_studio_" + std::to_string(port_) + "=" + token_; }

  Headers OwnHeaders() const {
    return {
        {"Host", host()}, {"Cookie", cookie()}, {"Origin", "http://" + host()}, {"X-Glint", "1"}};
  }
  Answer Get(const std::string& path) const {
    return Ask(port_, RequestText("GET", path, {{"Host", host()}, {"Cookie", cookie()}}));
  }
  Answer Send(const std::string& method, const std::string& path, const Json& json) const {
    Headers headers = OwnHeaders();
    headers.emplace_back("Content-Type", "application/json");
    return Ask(port_, RequestText(method, path, headers, json.dump()));
  }
  Answer Post(const std::string& path, const Json& json = Json::object()) const {
    return Send("POST", path, json);
  }
  // {file name, bytes}
  std::string UploadText(const std::string& path, const Headers& photographs) const {
    Headers headers = OwnHeaders();
    headers.emplace_back("Content-Type", "multipart/form-data; boundary=between-parts");
    return RequestText("POST", path, headers, Multipart(photographs));
  }
  Answer Upload(const std::string& path, const Headers& photographs) const {
    return Ask(port_, UploadText(path, photographs));
  }

  static std::string Multipart(const Headers& photographs) {
    std::string body;
    for (const auto& [name, bytes] : photographs) {
      body +=
          "--between-parts\r\nContent-Disposition: form-data; name=\"photographs\"; filename=\"";
      body.append(name).append("\"\r\nContent-Type: image/jpeg\r\n\r\n").append(bytes + "\r\n");
    }
    return body + "--between-parts--\r\n";
  }

 private:
  int port_ = 0;
  std::string token_;
};

}  // namespace glint::test
