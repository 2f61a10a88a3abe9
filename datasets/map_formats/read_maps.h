// SVBRDF maps as other programs and data sets store them.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "base/linearize/encoding.h"
#include "base/reflectance/svbrdf_maps.h"

namespace glint {

// How maps lie on disk:
//   kSvbrdfExr     svbrdf.exr of Glint (docs/conventions.md), or a folder that holds one
//   kDirStrip      DIR 2019: one picture of 4H×H: normal | diffuse | roughness | specular; diffuse
//   in
//                  gamma 2.2, the others linear
//   kPhotoStrip    Deschaintre et al. 2018: one picture of 5H×H: photo | normal | diffuse |
//   roughness |
//                  specular; all maps linear ("output linear parameters" in their program's notes)
//   kColorFolder   a folder named the ambientCG way: NAME_Color (sRGB), NAME_NormalGL,
//   NAME_Roughness,
//                  optionally NAME_Metalness, JPEG or PNG, all of one size
// Normals are OpenGL's (+Y up) everywhere and stored as (n + 1)/2; roughness is linear r.
enum class MapLayout { kSvbrdfExr, kDirStrip, kPhotoStrip, kColorFolder };

std::string_view MapLayoutName(MapLayout layout);

// For strips made with another choice; empty: the layout's own.
struct MapEncodings {
  std::optional<Encoding> diffuse, specular;
};

// Recognises the layout from what `path` is. Throws UserError when it is none of them.
MapLayout DetectMapLayout(const std::filesystem::path& path);

// Reads any of the layouts. Base colour c and metalness m give diffuse c·(1 − m) and specular
// F0 = 0.04·(1 − m) + c·m. Roughness is kept from 0 by 1/255's half; normals come out of unit
// length and in the upper half space. Throws UserError naming the file, what was found and the
// remedy.
SvbrdfMaps ReadMaps(const std::filesystem::path& path, const MapEncodings& encodings = {});

}  // namespace glint
