// What Ceres asks of a spot of paper.
#pragma once

#include <ceres/sized_cost_function.h>

#include "calib/light/light_state.h"

namespace glint::light {

// Residuals (seen − predicted) / (σ · scale) of R, G, B. Parameter blocks as those of Predict
// (light_model.h). The flash's part alone is differentiated automatically, by the four numbers it
// depends on; the rest is a product, whose derivatives are its factors'. Jets of all twenty numbers
// took five times as long.
class SpotCost final : public ceres::SizedCostFunction<3, 3, 3, 3, 3, 1, 1, 3, 3> {
 public:
  // Keeps a reference to the spot.
  SpotCost(const Spot& spot, double reference, double scale)
      : spot_(spot), reference_(reference), scale_(scale) {}
  bool Evaluate(const double* const* blocks, double* residual, double** jacobians) const override;

 private:
  const Spot& spot_;
  double reference_, scale_;
};

}  // namespace glint::light
