// Folders of maps named the ambientCG way: NAME_Color.jpg, NAME_NormalGL.png, …
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/reflectance/svbrdf_maps.h"

namespace glint {

// The folder's files by kind ("Color", "NormalGL", "Roughness", "Metalness"): the part of the stem
// after its last underscore. Throws UserError when a kind is there twice.
std::map<std::string, std::filesystem::path> FindMapFiles(const std::filesystem::path& folder);

// Throws UserError: a map missing, unreadable, or of another size than the colour map.
SvbrdfMaps ReadMapFolder(const std::filesystem::path& folder);

}  // namespace glint
