// Corrections of views in a manifest: data.corrections (docs/manifest.md).
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "fitting/view_correction/view_correction.h"
#include "pipeline/contract/manifest.h"

namespace glint {

Json JsonOf(const std::string& view, const ViewCorrection& correction);

// By the views' names; none where `data` has no corrections. Throws UserError.
std::map<std::string, ViewCorrection> ReadCorrections(const std::filesystem::path& manifest_file,
                                                      const Json& data);

}  // namespace glint
