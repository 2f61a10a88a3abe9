// How much memory a program may use: what would need more is refused by name before it is
// allocated, rather than ended by the kernel.
#pragma once

#include <cstdint>
#include <string>

namespace glint {

// `bytes` 0: 80 % of what the machine or its cgroup has (the rest is the system's and the file
// cache's). Called once, before other threads run.
void SetMemoryLimit(std::uint64_t bytes);
std::uint64_t MemoryLimit_bytes();

// "5.8 GB", "300 MB"
std::string MemoryText(double bytes);

}  // namespace glint
