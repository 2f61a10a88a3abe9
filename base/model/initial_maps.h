// Errors of the initial maps where none are stated.
#pragma once

#include "base/model/model_constant.h"

namespace glint::constants {

inline constexpr double kInitialNormalSd = 0.10, kInitialRoughnessSd = 0.10;
inline constexpr double kInitialDiffuseSd = 0.03, kInitialDiffuseRelativeSd = 0.1;
inline constexpr double kInitialSpecularSd = 0.02, kInitialSpecularRelativeSd = 0.2;
inline constexpr double kSeenAlready = 3;

inline constexpr ModelConstant kInitialMapsRows[] = {
    Row("kInitialNormalSd, kInitialRoughnessSd", {kInitialNormalSd, kInitialRoughnessSd}, "",
        "errors of n_x and n_y, and of roughness, where none are stated",
        "RMS of forty materials' latent fits: 0.10 to 0.14, 0.11 to 0.12"),
    Row("kInitialDiffuseSd, kInitialDiffuseRelativeSd",
        {kInitialDiffuseSd, kInitialDiffuseRelativeSd}, "albedo; relative",
        "errors of diffuse albedo, likewise: the sum of both", "the same fits: 0.03 to 0.06"),
    Row("kInitialSpecularSd, kInitialSpecularRelativeSd",
        {kInitialSpecularSd, kInitialSpecularRelativeSd}, "albedo; relative",
        "errors of specular albedo, likewise", "the same fits: 0.07 to 0.10"),
    Row("kSeenAlready", {kSeenAlready}, "factor",
        "on the albedos' errors from three photographs on; roughness and normals are not taken",
        "the initial maps were fitted to the same photographs; 1, 3, 10 compared"),
};

}  // namespace glint::constants
