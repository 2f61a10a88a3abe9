#include "datasets/evaluation/link_files.h"

namespace glint {

namespace fs = std::filesystem;

void LinkOrCopy(const fs::path& from, const fs::path& to) {
  fs::create_directories(to.parent_path());
  std::error_code error;
  fs::create_hard_link(from, to, error);
  if (error) fs::copy_file(from, to, fs::copy_options::overwrite_existing);
}

void LinkFolder(const fs::path& from, const fs::path& to) {
  fs::remove_all(to);
  for (const auto& entry : fs::directory_iterator(from)) {
    if (entry.is_regular_file()) LinkOrCopy(entry.path(), to / entry.path().filename());
  }
}

}  // namespace glint
