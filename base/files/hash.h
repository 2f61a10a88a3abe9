// Content hashes: XXH3-128 as 32 hex digits, prefixed "xxh3:".
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace glint {

std::string HashBytes(std::string_view bytes);
// Throws UserError when the file cannot be read.
std::string HashFile(const std::filesystem::path& file);

}  // namespace glint
