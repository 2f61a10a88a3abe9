// A texel as the solver sees it: its physical values, and the unbounded variables that the solver
// moves (texel_bounds.h).
#pragma once

#include <array>
#include <cstddef>

#include "base/reflectance/brdf.h"
#include "base/reflectance/svbrdf_maps.h"
#include "fitting/texel/texel_bounds.h"

namespace glint {

// Albedos come first and by channel: a channel's residuals depend on that channel's albedos only,
// so normal equations in this order have zeros between channels.
enum TexelParameter : int {
  kAlbedos = 0,  // diffuse.R, specular.R, diffuse.G, specular.G, diffuse.B, specular.B
  kRough = 6,
  kSlopeX,  // normal ∝ (slope_x, slope_y, 1)
  kSlopeY,
  kTexelParameters = 9
};
inline constexpr int DiffuseParameter(int channel) { return kAlbedos + 2 * channel; }
inline constexpr int SpecularParameter(int channel) { return kAlbedos + 2 * channel + 1; }

using TexelValues = std::array<double, kTexelParameters>;

// [J f]ᵀ[J f] of residuals f with Jacobian J: the normal equations with the squared norm of f in
// the last corner. Symmetric; only the upper triangle (column ≥ row) is used.
inline constexpr int kGramSize = kTexelParameters + 1;
using TexelGram = std::array<std::array<double, kGramSize>, kGramSize>;

// Value for the variable `u`, and its derivative.
double BoundedValue(const ValueBounds& bounds, double u, double* derivative);
// The variable for `value`; values nearer to a bound than 1 % of the tail are moved there.
double UnboundedVariable(const ValueBounds& bounds, double value);

// Physical values of the variables and dx_i/du_i.
void ToTexelValues(const double variables[kTexelParameters], TexelValues* values,
                   TexelValues* derivatives);
void ToVariables(const TexelValues& values, double variables[kTexelParameters]);

// Values as the reflectance model takes them; T may carry derivatives.
template <class T>
TexelSvbrdf<T> TexelFromValues(const T values[kTexelParameters]) {
  using std::sqrt;
  const T slope_x = values[kSlopeX], slope_y = values[kSlopeY];
  const T length = T(1) / sqrt(T(1) + slope_x * slope_x + slope_y * slope_y);
  TexelSvbrdf<T> texel{{slope_x * length, slope_y * length, length}, {}, {}, values[kRough]};
  for (int c = 0; c < 3; ++c) {
    texel.diffuse[c] = values[DiffuseParameter(c)];
    texel.specular[c] = values[SpecularParameter(c)];
  }
  return texel;
}

// One texel out of the maps and back. Reading clamps to what the variables can express.
TexelValues ReadTexel(const SvbrdfMaps& maps, size_t texel);
void WriteTexel(const TexelValues& values, size_t texel, SvbrdfMaps* maps);

}  // namespace glint
