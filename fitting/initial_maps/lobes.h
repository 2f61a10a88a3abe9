// One pair of lobes for the whole sample: what the mean brightness by angle tells of gloss.
#pragma once

#include <array>

#include "fitting/photographs/photographs.h"

namespace glint {

struct GlobalLobes {
  std::array<double, 3> diffuse{0.3, 0.3, 0.3};
  std::array<double, 3> specular{0.04, 0.04, 0.04};
  double roughness = 0.4;
};

// The sample is taken as flat and of one material. Reflectances I / (E·NoL) are collected by the
// angle between normal and half vector (medians, so that texture and scratches average out), and
// k_d/π + D·G·F/(4·NoL·NoV) is fitted to their logarithms over lists of roughness and specular
// albedo. Where an LDR photograph clips, the highlight is at least as bright. Weak preferences for
// the usual F0 and a moderate roughness decide where the photographs do not: a start too rough with
// too little specular is a minimum that fitting does not leave (Gao et al. 2019, Fig. 16).
GlobalLobes FitGlobalLobes(const PhotographSet& set);

}  // namespace glint
