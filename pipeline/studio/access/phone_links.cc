#include "pipeline/studio/access/phone_links.h"

#include <fmt/format.h>
#include <qrencode.h>

#include <algorithm>
#include <memory>

#include "base/errors/errors.h"
#include "pipeline/studio/access/token.h"

namespace glint {

double PhoneLinks::Left_s(const Kept& kept) const {
  const auto now = Clock::now();
  const double open_s = std::chrono::duration<double>(now - kept.opened).count();
  const double idle_s = std::chrono::duration<double>(now - kept.used).count();
  return std::min(longest_s_ - open_s, idle_s_ - idle_s);
}

PhoneLink PhoneLinks::Open(const std::string& capture) {
  const std::lock_guard<std::mutex> guard(mutex_);
  Kept& kept = links_[capture];
  kept = {RandomToken(), "", Clock::now(), Clock::now()};
  return {kept.token, capture, Left_s(kept)};
}

void PhoneLinks::Close(const std::string& capture) {
  const std::lock_guard<std::mutex> guard(mutex_);
  links_.erase(capture);
}

std::optional<PhoneLink> PhoneLinks::Of(const std::string& capture) {
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto found = links_.find(capture);
  if (found == links_.end() || Left_s(found->second) <= 0) return std::nullopt;
  return PhoneLink{found->second.token, capture, Left_s(found->second)};
}

std::optional<PhoneLink> PhoneLinks::Use(const std::string& token, const std::string& client_ip) {
  const std::lock_guard<std::mutex> guard(mutex_);
  for (auto& [capture, kept] : links_) {
    if (!SameSecret(kept.token, token)) continue;
    if (Left_s(kept) <= 0) return std::nullopt;
    if (kept.client_ip.empty()) kept.client_ip = client_ip;
    if (kept.client_ip != client_ip) return std::nullopt;
    kept.used = Clock::now();
    return PhoneLink{token, capture, Left_s(kept)};
  }
  return std::nullopt;
}

bool PhoneLinks::IsValid(const std::string& token) {
  const std::lock_guard<std::mutex> guard(mutex_);
  return std::any_of(links_.begin(), links_.end(), [&](const auto& one) {
    return SameSecret(one.second.token, token) && Left_s(one.second) > 0;
  });
}

std::string QrSvg(const std::string& text) {
  const std::unique_ptr<QRcode, void (*)(QRcode*)> code(
      QRcode_encodeString(text.c_str(), 0, QR_ECLEVEL_M, QR_MODE_8, 1), QRcode_free);
  if (!code) throw EnvironmentError("the address is too long for a QR code");
  constexpr int kQuiet = 4;  // modules, as ISO/IEC 18004 asks for
  const int side = code->width + 2 * kQuiet;
  std::string path;
  for (int y = 0; y < code->width; ++y) {
    for (int x = 0; x < code->width; ++x) {
      if ((code->data[y * code->width + x] & 1) == 0) continue;
      path += fmt::format("M{} {}h1v1h-1z", x + kQuiet, y + kQuiet);
    }
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {0}\" role=\"img\" "
      "aria-label=\"QR code\" shape-rendering=\"crispEdges\"><path fill=\"#fff\" "
      "d=\"M0 0h{0}v{0}h-{0}z\"/><path fill=\"#000\" d=\"{1}\"/></svg>",
      side, path);
}

}  // namespace glint
