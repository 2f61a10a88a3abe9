// The loss of maps against a set of photographs, LDR and HDR mixed, with a common light scale. A
// further term of maps or renderings belongs here, one of the latent code in CodeParameters::Prior
// (fit.cc).
#pragma once

#include <vector>

#include "base/reflectance/svbrdf_maps.h"
#include "fitting/encoding/encoding.h"
#include "fitting/photographs/photographs.h"

namespace glint {

struct FitLossValue {
  double loss = 0;
  EncodedMaps gradient;  // ∂loss/∂encoded maps
  double log_light_scale_gradient = 0;
  std::vector<double> view_loss;  // NaN where a photograph has no usable texel
};

class FitLoss {
 public:
  // `set` must outlive this.
  FitLoss(const PhotographSet& set, int threads) : set_(set), threads_(threads) {}

  FitLossValue Evaluate(const EncodedMaps& encoded, double light_scale, bool want_gradient) const;

 private:
  const PhotographSet& set_;
  int threads_;
};

}  // namespace glint
