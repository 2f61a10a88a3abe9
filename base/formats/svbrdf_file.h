// svbrdf.exr: the maps on disk (channels of docs/conventions.md).
#pragma once

#include <filesystem>

#include "base/reflectance/convention.h"
#include "base/reflectance/svbrdf_maps.h"

namespace glint {

void WriteSvbrdf(const std::filesystem::path& file, const SvbrdfMaps& maps,
                 const ReflectanceConvention& convention);

// Throws UserError: a missing channel, a value out of range or not finite, no convention.
SvbrdfMaps ReadSvbrdf(const std::filesystem::path& file,
                      ReflectanceConvention* convention = nullptr);

// `maps` resampled to width × height (area average down, bilinear up), normals renormalised.
SvbrdfMaps ResampleSvbrdf(const SvbrdfMaps& maps, int width, int height);

}  // namespace glint
