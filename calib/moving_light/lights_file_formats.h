// The readers that lights_file.h chooses from.
#pragma once

#include "calib/moving_light/lights_file.h"

namespace glint {

LightsFile ReadLpFile(const std::filesystem::path& file, const std::string& unit);
// .relight and .dome, which are JSON.
LightsFile ReadRelightFile(const std::filesystem::path& file, double picture_width_mm);

// The light that a vector stands for. `unit_mm`: of positions; 0: it is a direction, of about unit
// length. Throws UserError that names `place`.
ListedLight LightOf(const std::filesystem::path& file, const std::string& place,
                    const Eigen::Vector3d& vector, double unit_mm);

// "C:\photos\IMG_1.JPG" → "IMG_1.JPG".
std::string WithoutFolders(const std::string& name);

}  // namespace glint
