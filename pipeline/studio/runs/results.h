// A finished run as pages show it: maps, figures and files to take away.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/files/json.h"
#include "pipeline/studio/http/http_types.h"

namespace glint {

// Files that may be sent, by the name that stands in addresses: "report/index.html",
// "export/wood.glb", "previous/wood_basecolor.png" …; listed from the manifests and folders
// themselves, without links.
std::map<std::string, std::filesystem::path> ResultFiles(const std::filesystem::path& capture);

// The contract's Result; null: there is no report. `base` stands before the files' names in
// addresses.
Json ResultJson(const std::filesystem::path& capture, const std::string& base);

// Hard links to the exported maps, which the next run replaces: what "before" shows.
void KeepPreviousMaps(const std::filesystem::path& capture);

// The exported folder as a zip. Throws HttpError.
std::shared_ptr<FileToSend> ZipOfExport(const std::filesystem::path& capture);

// Opens a file that is to be sent; null: it is none, or a link.
std::shared_ptr<FileToSend> OpenToSend(const std::filesystem::path& file);
std::string TypeOfFile(const std::string& name);  // "image/png" …

}  // namespace glint
