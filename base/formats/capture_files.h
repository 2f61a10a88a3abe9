// The files that capture.toml names: by patterns, and frames of videos.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/toml_table.h"

namespace glint {

// Files of `folder` that match "some/folder/*.jpg", sorted by name, relative to `folder`. Patterns
// with * or ? may match none; a plain name must exist. Case is folded: phones write .JPG. Throws
// UserError that names `file` and `field`: a path out of the folder, a plain name without a file.
std::vector<std::string> MatchFiles(const std::filesystem::path& folder, const std::string& pattern,
                                    const std::filesystem::path& file, const std::string& field);

// Manifests name photographs, and JSON is UTF-8. Throws UserError where `name` is not.
void RequireUtf8(const std::filesystem::path& file, const std::string& field,
                 const std::string& name);

// Photographs of the table's `key` (patterns) and `video` (patterns too; one frame in `every`),
// each once, but for those that `left_out` lists by their paths, which `left_out` returns where it
// is not null. Throws UserError: as MatchFiles(), a name that is not UTF-8, too many.
std::vector<std::string> ReadPhotos(const std::filesystem::path& folder, const std::string& key,
                                    TomlTable* table, const std::filesystem::path& file,
                                    std::vector<std::string>* left_out = nullptr);

}  // namespace glint
