// Sharing files between capture folders without copying them.
#pragma once

#include <filesystem>

namespace glint {

// A hard link, or a copy where links cannot be. Throws std::filesystem::filesystem_error.
void LinkOrCopy(const std::filesystem::path& from, const std::filesystem::path& to);

// Makes `to` hold the files directly within `from`, and nothing else.
void LinkFolder(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace glint
