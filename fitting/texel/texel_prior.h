// The hold on a texel's start: residuals strength·(value − start)/error, in physical units.
// Quadratic: with a loss that flattens, texels whose photographs are explained in many ways
// wandered off (map error at five views one half higher).
#pragma once

#include "fitting/texel/texel_kernel.h"

namespace glint {

// Standard deviations expected of a start's error. Albedos: error + relative·value.
struct StartErrors {
  double normal = 0.10;  // of n_x, n_y
  double roughness = 0.10;
  double diffuse = 0.03;
  double diffuse_relative = 0.1;
  double specular = 0.02;
  double specular_relative = 0.2;
};

struct PriorWeights {
  double strength = 0.0;  // of one expected error, in units of the residuals; 0: no hold
  StartErrors errors;
};

class TexelPrior {
 public:
  TexelPrior(const PriorWeights& weights, const TexelValues& start);

  // Its kTexelParameters residuals and their derivatives by the physical values, row-major.
  void Evaluate(const TexelValues& texel, double residuals[kTexelParameters],
                double jacobian[kTexelParameters][kTexelParameters]) const;
  // Adds its residuals' products to a Gram matrix by the physical values (upper triangle).
  void AddTo(const TexelValues& texel, TexelGram* gram) const;
  const TexelValues& start() const { return start_; }
  // Weight of a squared departure of parameter `i`.
  double hold(int i) const { return weight_[i] * weight_[i]; }
  // Sum of its squared residuals.
  double SquaredNorm(const TexelValues& texel) const;

 private:
  double weight_[kTexelParameters];  // of the slopes: of n_x and n_y
  TexelValues start_;
  double start_normal_[2];
};

}  // namespace glint
