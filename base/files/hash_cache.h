// Content hashes of files that were hashed before and have not been touched since.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace glint {

// What tells a file that was touched: inode and the time of its last change of any kind (ctime,
// which neither `touch -d` nor `cp -p` nor `rsync -a` can set), beside size and modification time.
struct FileStamp {
  std::uint64_t device = 0, inode = 0, size = 0;
  std::int64_t modified_ns = 0, changed_ns = 0;
  bool operator==(const FileStamp&) const = default;
};

class HashCache {
 public:
  // Reads what `file` keeps; what is no such cache counts as empty.
  explicit HashCache(std::filesystem::path file);

  // HashFile() of the file's present content; empty: no regular file, or not readable.
  std::string Hash(const std::filesystem::path& path);

  // Keeps what was asked for. Failing to is no error: the next run hashes again.
  void Save() const;

 private:
  struct Entry {
    FileStamp stamp;
    std::string hash;
  };
  std::filesystem::path file_;
  std::map<std::string, Entry> known_, asked_;
};

}  // namespace glint
