// Files that are either whole or not there.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace glint {

// Whole text file. Throws UserError when missing, unreadable or larger than `limit_bytes`.
std::string ReadTextFile(const std::filesystem::path& file, std::size_t limit_bytes = 64u << 20);

// Writes beside the target, syncs, renames over it. Throws EnvironmentError (disk full, read-only).
void WriteFileAtomically(const std::filesystem::path& file, std::string_view bytes);

// `text` as the beginning of a file's name that needs no quotes anywhere: letters, digits, '-', '_'
// and '.' of ASCII, other bytes as '_', an 'm' before what begins with neither letter nor digit.
std::string FileNameOf(const std::string& text);

// An exclusive lock on `file` (created when missing), held until destruction and dropped by the
// kernel when the process dies. Throws UserError when another process holds it.
class FileLock {
 public:
  FileLock(const std::filesystem::path& file, const std::string& what);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  // Closed on exec by default; a child that keeps it open holds the lock too.
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
};

}  // namespace glint
