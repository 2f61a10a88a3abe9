// What physics knows of the specular albedo F0 at perpendicular incidence: dielectrics reflect 2 to
// 8 % of white light, metals a third to all of it in a colour of their own.
#pragma once

#include <string_view>

#include "base/model/substances.h"

namespace glint {

// A log-normal distribution of F0.
struct MaterialKind {
  double f0;              // its median
  double log_spread;      // standard deviation of its logarithm
  double coloured_share;  // of those with a colour in their highlights
};

// Indices of refraction of 1.33 to 1.8: two standard deviations.
// Highlights take the colour of what lies beneath where light from there is not diffuse, as in
// wood.
inline constexpr MaterialKind kDielectric{constants::kDielectricF0, constants::kDielectricLogSd,
                                          constants::kDielectricColouredShare};
// Iron and nickel .5, rusty or tarnished metals a third, silver .95.
inline constexpr MaterialKind kMetal{constants::kMetalF0, constants::kMetalLogSd,
                                     constants::kMetalColouredShare};

// Half of what dielectrics reflect at least: what is nearer to 0 is black to all photographs.
using constants::kSpecularOffset;

// Prior share of metals among the substances that people photograph ("rare"), and where there may
// be metal ("possible").
inline constexpr double MetalShareOf(std::string_view metals) {
  return metals == "possible" ? constants::kPossibleMetalShare : constants::kRareMetalShare;
}

}  // namespace glint
