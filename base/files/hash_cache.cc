#include "base/files/hash_cache.h"

#include <sys/stat.h>

#include <chrono>
#include <optional>
#include <utility>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/hash.h"
#include "base/files/json_file.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// A file that changed so shortly ago may change once more within the same tick of its clock.
constexpr std::int64_t kSettled_ns = 2'000'000'000;

std::int64_t Nanoseconds(const timespec& time) {
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

std::optional<FileStamp> StampOf(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return FileStamp{status.st_dev, status.st_ino, static_cast<std::uint64_t>(status.st_size),
                   Nanoseconds(status.st_mtim), Nanoseconds(status.st_ctim)};
}

bool Settled(const FileStamp& stamp) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() - stamp.changed_ns >
         kSettled_ns;
}

}  // namespace

HashCache::HashCache(fs::path file) : file_(std::move(file)) {
  if (!fs::exists(file_)) return;
  try {
    const Json json = ReadJsonFile(file_, "");
    for (const auto& [path, entry] : json.items()) {
      const auto& stamp = entry.at("stamp");
      // A number too large for an integer is read as a float, which no integer need hold.
      for (const Json& number : stamp) {
        if (!number.is_number_integer()) throw UserError(file_, "stamp", number.dump(), "");
      }
      known_[path] = {{stamp.at(0), stamp.at(1), stamp.at(2), stamp.at(3), stamp.at(4)},
                      entry.at("hash")};
    }
  } catch (const UserError&) {
    known_.clear();
  } catch (const nlohmann::json::exception&) {
    known_.clear();
  }
}

std::string HashCache::Hash(const fs::path& path) {
  const std::optional<FileStamp> stamp = StampOf(path);
  if (!stamp) return "";
  const std::string name = fs::absolute(path).lexically_normal().generic_string();
  const auto found = known_.find(name);
  Entry entry{*stamp, ""};
  if (found != known_.end() && found->second.stamp == *stamp) {
    entry.hash = found->second.hash;
  } else {
    try {
      entry.hash = HashFile(path);
    } catch (const UserError&) {
      return "";
    }
  }
  if (Settled(*stamp)) asked_[name] = entry;
  return entry.hash;
}

void HashCache::Save() const {
  Json json = Json::object();
  for (const auto& [path, entry] : asked_) {
    const FileStamp& s = entry.stamp;
    json[path] = {{"stamp", {s.device, s.inode, s.size, s.modified_ns, s.changed_ns}},
                  {"hash", entry.hash}};
  }
  try {
    WriteFileAtomically(file_, json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
  } catch (const Error&) {
  }
}

}  // namespace glint
