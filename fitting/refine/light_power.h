// Maps under a light of another power: albedos trade off with it, and look the same.
#pragma once

#include <vector>

#include "base/reflectance/convention.h"
#include "base/reflectance/svbrdf_maps.h"

namespace glint {

// Maps that look under a light `power` times as strong as they did before, but for Fresnel's rim,
// which no flash beside a lens lights. `confidence`: planes of DeviationPlane and what follows
// them.
void SetUnderPower(double power, DiffuseWeight weight, SvbrdfMaps* maps,
                   std::vector<float>* confidence);

}  // namespace glint
