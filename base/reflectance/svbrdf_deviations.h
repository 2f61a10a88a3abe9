// Standard deviations of SVBRDF maps, texel by texel.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace glint {

// Planes of SvbrdfDeviations, in storage order, in the maps' units.
enum DeviationPlane : int {
  kSigmaNormalX,
  kSigmaNormalY,
  kSigmaDiffuseR,
  kSigmaDiffuseG,
  kSigmaDiffuseB,
  kSigmaSpecularR,
  kSigmaSpecularG,
  kSigmaSpecularB,
  kSigmaRoughness,
  kDeviationPlanes
};

// H×W texels, planar, as SvbrdfMaps. Without texels: nothing is stated.
struct SvbrdfDeviations {
  int width = 0;
  int height = 0;
  std::vector<float> planes;

  SvbrdfDeviations() = default;
  SvbrdfDeviations(int width_in, int height_in)
      : width(width_in),
        height(height_in),
        planes(static_cast<size_t>(kDeviationPlanes) * width_in * height_in, 0.0f) {}

  bool empty() const { return planes.empty(); }
  size_t texels() const { return static_cast<size_t>(width) * height; }
  std::span<float> plane(int p) { return {planes.data() + p * texels(), texels()}; }
  std::span<const float> plane(int p) const { return {planes.data() + p * texels(), texels()}; }
};

}  // namespace glint
