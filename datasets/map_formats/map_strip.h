// Strips: square maps side by side in one picture.
#pragma once

#include <filesystem>

#include "datasets/map_formats/read_maps.h"

namespace glint {

// `layout` is kDirStrip or kPhotoStrip.
SvbrdfMaps ReadMapStrip(const std::filesystem::path& file, MapLayout layout,
                        const MapEncodings& encodings);

}  // namespace glint
