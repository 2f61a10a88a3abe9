// JSON files as people and other programs may have left them.
#pragma once

#include <filesystem>
#include <string>

#include "base/files/json.h"

namespace glint {

// The file's content. Throws UserError: unreadable, larger than `limit_bytes`, no JSON, nested more
// than 64 deep (base/text/json_depth.h). `remedy`: what to do about it, for the message.
Json ReadJsonFile(const std::filesystem::path& file, const std::string& remedy,
                  std::size_t limit_bytes = 64u << 20);

}  // namespace glint
