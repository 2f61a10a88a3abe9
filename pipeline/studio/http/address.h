// Addresses of this machine in its networks.
#pragma once

#include <string>
#include <vector>

namespace glint {

// IPv4 addresses of the network interfaces that are up, without loopback; those that a home network
// gives (192.168.…, 10.…, 172.16 … 172.31) first.
std::vector<std::string> LanAddresses();

}  // namespace glint
