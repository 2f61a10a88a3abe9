// How much memory this process could have.
#pragma once

#include <cstdint>
#include <filesystem>

namespace glint {

// The machine's memory, or less where the process' cgroup has a limit (containers, Slurm), bytes.
std::uint64_t MachineMemory_bytes();

// The least limit of the cgroup that `membership` (/proc/self/cgroup) names below `root`
// (/sys/fs/cgroup) and of its parents; version 2, or the memory controller of version 1. 0: none.
std::uint64_t CgroupMemory_bytes(const std::filesystem::path& membership,
                                 const std::filesystem::path& root);

}  // namespace glint
