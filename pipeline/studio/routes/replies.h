// Replies of each sort.
#pragma once

#include <filesystem>
#include <string>

#include "base/errors/errors.h"
#include "base/files/json.h"
#include "pipeline/studio/http/http_types.h"

namespace glint {

HttpReply JsonReply(const Json& json);
HttpReply FileReply(const std::filesystem::path& file, const std::string& type);
// A file of Studio's own pages, "studio.html".
HttpReply PageReply(const std::string& name);

// What a program's or library's error says, with its remedy apart.
HttpError ToldWith(int status, const Error& error);

[[noreturn]] void ThrowNotFound();

}  // namespace glint
