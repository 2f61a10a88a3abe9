// SVBRDF maps in memory: what the whole of Glint estimates.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace glint {

// Planes of SvbrdfMaps, in storage order. Linear values, float32.
enum SvbrdfPlane : int {
  kNormalX,  // unit normal, sample frame: x right, y up (toward map row 0), z toward the viewer
  kNormalY,
  kNormalZ,
  kDiffuseR,  // diffuse albedo k_d, linear Rec.709, [0, 1]
  kDiffuseG,
  kDiffuseB,
  kSpecularR,  // specular albedo k_s = F0, linear, [0, 1]
  kSpecularG,
  kSpecularB,
  kRoughness,  // r in (0, 1]; the GGX α is r²
  kSvbrdfPlanes
};

// H×W texels, planar: plane p is the contiguous block [p·H·W, (p+1)·H·W), rows top (+y) to bottom.
struct SvbrdfMaps {
  int width = 0;
  int height = 0;
  std::vector<float> planes;

  SvbrdfMaps() = default;
  SvbrdfMaps(int width_in, int height_in)
      : width(width_in),
        height(height_in),
        planes(static_cast<size_t>(kSvbrdfPlanes) * width_in * height_in, 0.0f) {}

  size_t texels() const { return static_cast<size_t>(width) * height; }
  std::span<float> plane(int p) { return {planes.data() + p * texels(), texels()}; }
  std::span<const float> plane(int p) const { return {planes.data() + p * texels(), texels()}; }
  float& at(int p, int row, int column) {
    return planes[p * texels() + static_cast<size_t>(row) * width + column];
  }
  float at(int p, int row, int column) const {
    return planes[p * texels() + static_cast<size_t>(row) * width + column];
  }
};

}  // namespace glint
