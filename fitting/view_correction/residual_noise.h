// What remains between photographs and model: how much, and how much of it the channels share.
//
// Noise of a sensor and of 8 bits is each channel's own; a displaced picture, a light that is not
// where it was said to be, a model that is too simple put all three channels off alike. Three
// residuals that share their error tell as much as one: counted as three, every start is let go
// too easily and every standard deviation comes out too small by √3.
#pragma once

#include "fitting/texel/texel_batch.h"

namespace glint {

// Collects texels' residuals at their solutions; what they share is seen over views and texels.
class ResidualNoise {
 public:
  // Of a lane's texel at its solution. `variance`: of its residuals; texels count alike whatever it
  // is.
  void Add(const BatchObservations& observations, const BatchResiduals& residuals, int lane,
           double variance);
  void Add(const ResidualNoise& other);
  // How often as large a variance is to be reckoned with as if residuals were independent, from 1
  // (they are) to 3 (the channels of a view are one). 1 where too few views tell.
  double Shared() const;

 private:
  double common_ = 0, common_freedom_ = 0;  // squares of the channels' common part, of the rest
  double other_ = 0, other_freedom_ = 0;
};

}  // namespace glint
