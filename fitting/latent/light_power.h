// The light's power where nobody measured it, from how well the estimator explains photographs.
#pragma once

#include "fitting/estimator/estimator.h"
#include "fitting/photographs/photographs.h"

namespace glint {

struct PowerEstimate {
  double factor = 1;  // what every light_rgb is to be multiplied with
  double log_l1 = 0,
         as_given = 0;  // losses of the estimator's maps: with it, and with the power given
};

// Albedos and the light's power trade off, but not at will: albedos are at most 1, most samples are
// dielectrics that reflect 4 %, and white paper under a light that is taken for too weak can only
// be metal. The estimator knows what materials are like; told a wrong power, it finds none that
// looks like the photographs. So the power is the one whose maps, rendered, are nearest to them
// (eq. 2 of Gao et al. 2019), of factors from ⅛ to 8 in half octaves. Photographs of any size; they
// are averaged to what the estimator was trained on.
PowerEstimate EstimatePower(const Estimator& estimator, const PhotographSet& set,
                            const EstimatorConditions& conditions, int threads);

// The set with every light's power multiplied.
PhotographSet WithPower(PhotographSet set, double factor);

}  // namespace glint
