// The material at a glance: lit by a flash above it, small.
#pragma once

#include <string>

#include "base/reflectance/convention.h"
#include "base/reflectance/svbrdf_maps.h"

namespace glint {

inline constexpr int kThumbnail_px = 192;  // its longer side

// A JPEG file's bytes. Exposed by the rendering's own median, so that dark materials show too.
std::string ThumbnailJpeg(const SvbrdfMaps& maps, const ReflectanceConvention& convention);

}  // namespace glint
