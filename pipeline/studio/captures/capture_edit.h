// Changes of a capture.toml that others may be changing too.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "base/formats/capture.h"

namespace glint {

// Reads, lets `edit` change the text, and writes if the file is still the one that was read; else
// begins again. Throws HttpError 409 where somebody changes it all the time.
void EditCapture(const std::filesystem::path& folder,
                 const std::function<std::string(const Capture&, const std::string&)>& edit);

// Lists a photograph that lies in the capture's photos/, unless it is listed. The first one of a
// draft makes it a capture.
void ListPhoto(const std::filesystem::path& folder, const std::filesystem::path& file);

// Changes which places are left out.
void EditLeftOut(const std::filesystem::path& folder,
                 const std::function<void(std::set<std::string>*)>& edit);

}  // namespace glint
