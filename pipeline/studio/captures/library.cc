#include "pipeline/studio/captures/library.h"

#include <fcntl.h>
#include <stdio.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "base/errors/errors.h"
#include "base/files/hash.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kMostDeep = 5;
constexpr size_t kMostCaptures = 5000;
constexpr size_t kMostFolders = 20000;  // a second's work; somebody's whole home has more

bool IsCapture(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "capture.toml", error) ||
         fs::is_regular_file(folder / kDraftFile, error);
}

void Look(const fs::path& root, const fs::path& folder, int deep, size_t* looked_at,
          std::vector<LibraryEntry>* found) {
  if (found->size() >= kMostCaptures || ++*looked_at > kMostFolders) return;
  if (IsCapture(folder)) {
    const std::string place = folder.lexically_relative(root).generic_string();
    found->push_back({IdOf(place), folder.filename().string(), folder});
    return;
  }
  if (deep == 0) return;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename();
    if (name[0] == '.' || entry.is_symlink(error) || !entry.is_directory(error)) continue;
    Look(root, entry.path(), deep - 1, looked_at, found);
  }
}

std::string TimeText() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::localtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d_%H.%M.%S", &parts);
  return text;
}

}  // namespace

std::string IdOf(const std::string& name) {
  constexpr size_t kDigits = 16;
  const std::string hash = HashBytes(name);
  return hash.substr(hash.find(':') + 1, kDigits);
}

fs::path StudioFolderOf(const fs::path& capture) { return capture / "glint" / ".studio"; }

std::vector<LibraryEntry> FindCaptures(const fs::path& root) {
  std::vector<LibraryEntry> found;
  size_t looked_at = 0;
  Look(root, root, kMostDeep, &looked_at, &found);
  std::sort(found.begin(), found.end(),
            [](const LibraryEntry& a, const LibraryEntry& b) { return a.folder < b.folder; });
  return found;
}

fs::path MoveToTrash(const fs::path& root, const LibraryEntry& entry) {
  const fs::path trash = root / kTrashFolder;
  std::error_code error;
  fs::create_directories(trash, error);
  const std::string name = entry.name + "-" + TimeText();
  for (int attempt = 1; attempt < 100; ++attempt) {
    fs::path to = trash / (attempt == 1 ? name : name + "-" + std::to_string(attempt));
    if (::renameat2(AT_FDCWD, entry.folder.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) {
      return to;
    }
    if (errno != EEXIST) break;
  }
  throw EnvironmentError(entry.folder.string() + ": cannot be moved to " + trash.string() + ": " +
                         std::strerror(errno) + "; move it yourself");
}

}  // namespace glint
