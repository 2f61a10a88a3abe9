// Starting points of fitting, to learn how much they decide (Figs. 6 and 16 of Gao et al. 2019).
#pragma once

#include <string>

#include "datasets/evaluation/experiment.h"

namespace glint {

// `method` from another start; its name becomes START-METHOD. `start` is one of
//   random     blocks of 32 texels of independent maps: the auto-encoder's code has an element for
//              each, so that its start is as random as a random code
//   heuristic  glint-fit --initial-maps rules
//   network    glint-fit --initial-maps estimator
//   truth      the true maps
//   rough      the true maps with roughness .3 larger and half the specular albedo: the local
//              minimum of Fig. 16
// Throws UserError for other names.
Method WithStart(Method method, const std::string& start);

}  // namespace glint
