#include "base/files/memory_limit.h"

#include <fmt/format.h>

#include "base/memory/machine_memory.h"

namespace glint {
namespace {

constexpr double kShareOfMachine = 0.8;
std::uint64_t limit_bytes = 0;

}  // namespace

void SetMemoryLimit(std::uint64_t bytes) { limit_bytes = bytes; }

std::uint64_t MemoryLimit_bytes() {
  if (limit_bytes != 0) return limit_bytes;
  static const auto default_bytes =
      static_cast<std::uint64_t>(kShareOfMachine * static_cast<double>(MachineMemory_bytes()));
  return default_bytes;
}

std::string MemoryText(double bytes) {
  constexpr double kGiga = 1e9, kMega = 1e6;
  return bytes < kGiga ? fmt::format("{:.0f} MB", bytes / kMega)
                       : fmt::format("{:.1f} GB", bytes / kGiga);
}

}  // namespace glint
