#include "pipeline/studio/http/address.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>

namespace glint {
namespace {

bool IsPrivate(const std::string& address) {
  unsigned a = 0, b = 0;
  if (std::sscanf(address.c_str(), "%u.%u.", &a, &b) != 2) return false;
  return a == 10 || (a == 192 && b == 168) || (a == 172 && b >= 16 && b <= 31);
}

// Bridges of containers and virtual machines, which no phone is in.
bool IsVirtual(const std::string& interface) {
  return interface.starts_with("docker") || interface.starts_with("br-") ||
         interface.starts_with("virbr") || interface.starts_with("veth");
}

}  // namespace

std::vector<std::string> LanAddresses() {
  struct Found {
    std::string address;
    int rank;
  };
  std::vector<Found> found;
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return {};
  for (const ifaddrs* one = list; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    if ((one->ifa_flags & IFF_UP) == 0 || (one->ifa_flags & IFF_LOOPBACK) != 0) continue;
    char text[INET_ADDRSTRLEN];
    const auto* address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    if (::inet_ntop(AF_INET, &address->sin_addr, text, sizeof text) == nullptr) continue;
    found.push_back({text, (IsPrivate(text) ? 0 : 1) + (IsVirtual(one->ifa_name) ? 2 : 0)});
  }
  ::freeifaddrs(list);
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return a.rank < b.rank; });
  std::vector<std::string> addresses;
  addresses.reserve(found.size());
  for (const Found& one : found) addresses.push_back(one.address);
  return addresses;
}

}  // namespace glint
