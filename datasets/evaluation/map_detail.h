// How much fine structure estimated maps have, and whether it is the true one: "sharp", "blurry"
// and "noisy" as numbers.
#pragma once

#include "base/reflectance/svbrdf_maps.h"

namespace glint {

// Differences of neighbouring texels, along rows and columns, of all channels together: diffuse,
// specular and roughness as stored, normals as (n + 1)/2, each kind's channels averaged as in
// MapErrors, so that all four kinds count alike.
struct MapDetail {
  // Their mean square over that of the truth: below 1 blurred, above 1 noisy.
  double energy = 0;
  // Their correlation with the truth's, at most 1: detail that is there but is not the truth's
  // (noise, wrong sharpness) lowers it.
  double agreement = 0;
};

// Both of one size, at least 2 texels along a side (std::invalid_argument otherwise). A truth
// without any detail has energy 0 of it, agreement 0.
MapDetail CompareDetail(const SvbrdfMaps& estimate, const SvbrdfMaps& truth);

}  // namespace glint
