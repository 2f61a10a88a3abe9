#include "base/memory/machine_memory.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace glint {
namespace {

namespace fs = std::filesystem;

// 0 where there is no number ("max") or no file.
std::uint64_t NumberIn(const fs::path& file) {
  std::ifstream stream(file);
  std::uint64_t number = 0;
  return stream >> number ? number : 0;
}

std::uint64_t Least(std::uint64_t a, std::uint64_t b) {
  if (a == 0 || b == 0) return std::max(a, b);
  return std::min(a, b);
}

}  // namespace

std::uint64_t CgroupMemory_bytes(const fs::path& membership, const fs::path& root) {
  std::ifstream stream(membership);
  std::uint64_t least = 0;
  // "0::/user.slice/x" (version 2), "9:memory:/x" (version 1)
  for (std::string line; std::getline(stream, line);) {
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool unified = controllers.empty();
    if (!unified && ("," + controllers + ",").find(",memory,") == std::string::npos) continue;
    const fs::path base = unified ? root : root / "memory";
    const char* file = unified ? "memory.max" : "memory.limit_in_bytes";
    for (fs::path group = line.substr(second + 1);; group = group.parent_path()) {
      least = Least(least, NumberIn(base / group.relative_path() / file));
      if (!group.has_relative_path()) break;
    }
  }
  return least;
}

std::uint64_t MachineMemory_bytes() {
  const std::uint64_t machine = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                                static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return Least(machine, CgroupMemory_bytes("/proc/self/cgroup", "/sys/fs/cgroup"));
}

}  // namespace glint
