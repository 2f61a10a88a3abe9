// What is known of a texel beforehand: a Gaussian of each of its values.
//
// Several sources of knowledge (the initialisation, the texel's substance, its neighbours)
// multiply: precisions add, means are weighted by them. Normals are judged by n_x and n_y, all else
// by the values themselves (logarithms of specular albedo let what no highlight reaches turn
// glossy: docs/experiments/statistical-model.md). As residuals: scale · √precision · (value −
// mean), with `scale` the standard deviation of the photographs' residuals, so that both kinds of
// squares add up to twice the negative log posterior in units of scale².
#pragma once

#include <array>

#include "base/model/initial_maps.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {

// Standard deviations expected of an initialisation's error. Albedos: error + relative·value.
struct InitialisationErrors {
  double normal = constants::kInitialNormalSd;  // of n_x, n_y
  double roughness = constants::kInitialRoughnessSd;
  double diffuse = constants::kInitialDiffuseSd;
  double diffuse_relative = constants::kInitialDiffuseRelativeSd;
  double specular = constants::kInitialSpecularSd;
  double specular_relative = constants::kInitialSpecularRelativeSd;

  void Scale(double factor) {
    for (double* error :
         {&normal, &roughness, &diffuse, &diffuse_relative, &specular, &specular_relative}) {
      *error *= factor;
    }
  }
};

// In the parameters' order; n_x and n_y in the slopes' places.
class TexelGaussian {
 public:
  // Knows nothing.
  TexelGaussian() = default;
  // Values with the errors of an initialisation.
  TexelGaussian(const TexelValues& initial, const InitialisationErrors& errors);
  // Values with standard deviations, in the parameters' order and of n_x and n_y.
  TexelGaussian(const TexelValues& initial, const std::array<double, kTexelParameters>& sd);

  // Multiplies with a Gaussian of one value. precision ≥ 0.
  void Multiply(int parameter, double mean, double precision);

  // In place of what was known of the value.
  void Set(int parameter, double mean, double precision) {
    mean_[static_cast<size_t>(parameter)] = mean;
    precision_[static_cast<size_t>(parameter)] = precision;
  }

  double mean(int i) const { return mean_[i]; }
  double precision(int i) const { return precision_[i]; }

 private:
  std::array<double, kTexelParameters> mean_{}, precision_{};
};

// n_x, n_y of slopes and back.
void NormalOfSlopes(double slope_x, double slope_y, double normal[2]);

class TexelPrior {
 public:
  TexelPrior() = default;  // none
  TexelPrior(const TexelGaussian& gaussian, double scale);

  // Its kTexelParameters residuals and their derivatives by the physical values, row-major.
  void Evaluate(const TexelValues& texel, double residuals[kTexelParameters],
                double jacobian[kTexelParameters][kTexelParameters]) const;
  // Adds its residuals' products to a Gram matrix by the physical values (upper triangle).
  void AddTo(const TexelValues& texel, TexelGram* gram) const;
  // The most probable texel.
  const TexelValues& mean() const { return mean_; }
  double mean_normal(int axis) const { return mean_normal_[axis]; }  // n_x, n_y
  // Weight of a squared departure of parameter `i`.
  double weight(int i) const { return weight_[i] * weight_[i]; }
  // Sum of its squared residuals.
  double SquaredNorm(const TexelValues& texel) const;

 private:
  double weight_[kTexelParameters] = {};  // of the slopes: of n_x and n_y
  double mean_normal_[2] = {0, 0};
  TexelValues mean_{};
};

}  // namespace glint
