// Another program's renderings, beside which ours are judged.
#pragma once

#include <filesystem>
#include <vector>

namespace glint {

// A picture of gamma 2.2 as linear radiance [3·H·W], averaged or interpolated to the size asked
// for. Throws UserError.
std::vector<float> ReadTheirRendering(const std::filesystem::path& file, int width, int height);

}  // namespace glint
