// Links by which a phone sends photographs: each reaches one capture, belongs to the phone that
// opens it first, and expires.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace glint {

struct PhoneLink {
  std::string token, capture;
  double expires_s = 0;  // from now
};

class PhoneLinks {
 public:
  // A link stays valid this long after it was last used, since a session of photographs takes as
  // long, and at most `longest_s` in all.
  explicit PhoneLinks(double idle_s = 1800, double longest_s = 4 * 3600)
      : idle_s_(idle_s), longest_s_(longest_s) {}

  // A new link; the capture's earlier one ends.
  PhoneLink Open(const std::string& capture);
  void Close(const std::string& capture);
  std::optional<PhoneLink> Of(const std::string& capture);
  // none: unknown, expired, or opened before by a client of another address.
  std::optional<PhoneLink> Use(const std::string& token, const std::string& client_ip);
  bool IsValid(const std::string& token);

 private:
  using Clock = std::chrono::steady_clock;
  struct Kept {
    std::string token, client_ip;
    Clock::time_point opened, used;
  };
  double Left_s(const Kept& kept) const;

  double idle_s_, longest_s_;
  std::mutex mutex_;
  std::map<std::string, Kept> links_;  // by capture
};

// The text as a QR code, black on white with a quiet zone: an SVG element that scales. Throws
// EnvironmentError for a text that is too long.
std::string QrSvg(const std::string& text);

}  // namespace glint
