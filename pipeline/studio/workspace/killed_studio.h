// What a Studio left unfinished that was killed.
#pragma once

#include <filesystem>
#include <vector>

#include "pipeline/studio/captures/library.h"

namespace glint {

// Removes half-made captures, interrupted uploads and unfinished texts, and describes a capture of
// one photograph whose photograph had just arrived. Only for whoever has the folder's lock.
void TidyAfterKilledStudio(const std::filesystem::path& root,
                           const std::vector<LibraryEntry>& captures);

}  // namespace glint
