#include "fitting/texel/texel_parameters.h"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

const ValueBounds& BoundsOf(int parameter) {
  return parameter == kRough ? kRoughnessBounds : kAlbedoBounds;
}

}  // namespace

double BoundedValue(const ValueBounds& bounds, double u, double* derivative) {
  const double below = bounds.low + bounds.tail - u;
  const double above = u - (bounds.high - bounds.tail);
  if (below <= 0.0 && above <= 0.0) {
    *derivative = 1.0;
    return u;
  }
  const double depth = std::min(std::max(below, above) / bounds.tail, kFarthestTail);
  *derivative = std::exp(-depth);
  return below > 0.0 ? bounds.low + bounds.tail * *derivative
                     : bounds.high - bounds.tail * *derivative;
}

double UnboundedVariable(const ValueBounds& bounds, double value) {
  const double nearest = kNearestToBound * bounds.tail;
  const double x = std::clamp(value, bounds.low + nearest, bounds.high - nearest);
  if (x < bounds.low + bounds.tail) {
    return bounds.low + bounds.tail * (1.0 + std::log((x - bounds.low) / bounds.tail));
  }
  if (x > bounds.high - bounds.tail) {
    return bounds.high - bounds.tail * (1.0 + std::log((bounds.high - x) / bounds.tail));
  }
  return x;
}

void ToTexelValues(const double variables[kTexelParameters], TexelValues* values,
                   TexelValues* derivatives) {
  for (int i = 0; i < kTexelParameters; ++i) {
    if (i == kSlopeX || i == kSlopeY) {
      (*values)[i] = variables[i];
      (*derivatives)[i] = 1.0;
    } else {
      (*values)[i] = BoundedValue(BoundsOf(i), variables[i], &(*derivatives)[i]);
    }
  }
}

void ToVariables(const TexelValues& values, double variables[kTexelParameters]) {
  for (int i = 0; i < kTexelParameters; ++i) {
    variables[i] =
        i == kSlopeX || i == kSlopeY ? values[i] : UnboundedVariable(BoundsOf(i), values[i]);
  }
}

TexelValues ReadTexel(const SvbrdfMaps& maps, size_t texel) {
  const auto at = [&](int plane) { return static_cast<double>(maps.plane(plane)[texel]); };
  TexelValues values;
  const double z = std::max(at(kNormalZ), 1e-3);
  double x = at(kNormalX) / z, y = at(kNormalY) / z;
  const double slope = std::sqrt(x * x + y * y);
  if (slope > kMostSlope) {
    x *= kMostSlope / slope;
    y *= kMostSlope / slope;
  }
  values[kSlopeX] = x;
  values[kSlopeY] = y;
  values[kRough] = std::clamp(at(kRoughness), kRoughnessBounds.low, kRoughnessBounds.high);
  for (int c = 0; c < 3; ++c) {
    values[DiffuseParameter(c)] = std::clamp(at(kDiffuseR + c), 0.0, 1.0);
    values[SpecularParameter(c)] = std::clamp(at(kSpecularR + c), 0.0, 1.0);
  }
  return values;
}

void WriteTexel(const TexelValues& values, size_t texel, SvbrdfMaps* maps) {
  const double x = values[kSlopeX], y = values[kSlopeY];
  const double length = 1.0 / std::sqrt(1.0 + x * x + y * y);
  maps->plane(kNormalX)[texel] = static_cast<float>(x * length);
  maps->plane(kNormalY)[texel] = static_cast<float>(y * length);
  maps->plane(kNormalZ)[texel] = static_cast<float>(length);
  maps->plane(kRoughness)[texel] = static_cast<float>(values[kRough]);
  for (int c = 0; c < 3; ++c) {
    maps->plane(kDiffuseR + c)[texel] = static_cast<float>(values[DiffuseParameter(c)]);
    maps->plane(kSpecularR + c)[texel] = static_cast<float>(values[SpecularParameter(c)]);
  }
}

}  // namespace glint
