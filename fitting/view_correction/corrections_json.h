// What was corrected, in a manifest: data.corrections, data.shared_light
// and data.room_light, environment lighting (docs/manifest.md; the key is older than the name).
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/formats/manifest.h"
#include "fitting/view_correction/shared_light.h"
#include "fitting/view_correction/view_correction.h"

namespace glint {

Json JsonOf(const std::string& view, const ViewCorrection& correction);

// By the views' names; none where `data` has no corrections. Throws UserError.
std::map<std::string, ViewCorrection> ReadCorrections(const std::filesystem::path& manifest_file,
                                                      const Json& data);

Json JsonOf(const SharedLight& shared);

// data.shared_light; as said where `data` has none. Throws UserError.
SharedLight ReadSharedLight(const std::filesystem::path& manifest_file, const Json& data);

Json JsonOf(const EnvironmentLighting& environment);

Json JsonOf(const SystematicDeviations& deviations);

// Dark where `data` has no room_light. Throws UserError.
EnvironmentLighting ReadEnvironmentLighting(const std::filesystem::path& manifest_file,
                                            const Json& data);

}  // namespace glint
