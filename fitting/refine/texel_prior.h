// The hold on a texel's start: residuals weight·(value − start), in physical units.
#pragma once

#include "fitting/refine/texel_kernel.h"

namespace glint {

// Square roots of weights: how strongly each kind of value is held.
struct PriorWeights {
  double normal = 0.0;  // of n_x and n_y
  double roughness = 0.0;
  double diffuse = 0.0;
  double specular = 0.0;
};

class TexelPrior {
 public:
  TexelPrior(const PriorWeights& weights, const TexelValues& start);

  // Its kTexelParameters residuals and their derivatives by the physical values, row-major.
  void Evaluate(const TexelValues& texel, double residuals[kTexelParameters],
                double jacobian[kTexelParameters][kTexelParameters]) const;
  // Adds its residuals' products to a Gram matrix by the physical values (upper triangle).
  void AddTo(const TexelValues& texel, TexelGram* gram) const;
  // Sum of its squared residuals.
  double SquaredNorm(const TexelValues& texel) const;

 private:
  double weight_[kTexelParameters];  // of the slopes: of n_x and n_y
  TexelValues start_;
  double start_normal_[2];
};

}  // namespace glint
