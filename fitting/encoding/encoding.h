// How SVBRDF maps become the nine channels in [−1, 1] that the auto-encoder reads and writes.
//
//   channel  0–2  diffuse R, G, B   t = 2·√c − 1        (dark colours get their share of the range)
//            3–5  specular R, G, B  t = 2·√c − 1
//            6    roughness         t = 2·(r − r₀)/(1 − r₀) − 1,  r₀ = kMinRoughness
//            7–8  normal x, y       the slopes s = n_x/n_z, n_y/n_z by  s = t + 3·t³
//
// The cubic gives small slopes the paper's resolution (ds/dt = 1 at 0) and still reaches s = ±4 at
// t = ±1: 76.0° along an axis, 80.0° along a diagonal, where (x, y, 1) alone ends at 54.7°. Degrees
// per unit of t are then nearly uniform. Slopes are multiplied by −1 under a mirror, as t is.
//
// Planar float buffers: plane p is [p·texels, (p+1)·texels). Pure functions, no allocation.
#pragma once

#include <cstddef>
#include <vector>

#include "base/reflectance/svbrdf_maps.h"

namespace glint {

inline constexpr int kEncodedChannels = 9;
inline constexpr float kMinRoughness = 0.02f;
inline constexpr float kMaxSlope = 4.0f;
// Written into weights files: weights trained for another encoding are refused.
inline constexpr char kEncodingName[] = "sqrt-diffuse sqrt-specular roughness cubic-slope v1";

enum EncodedPlane : int {
  kEncodedDiffuse = 0,
  kEncodedSpecular = 3,
  kEncodedRoughness = 6,
  kEncodedNormal = 7
};

// `maps`: kSvbrdfPlanes planes in the order of SvbrdfPlane. Values outside the ranges are clamped,
// values that are not finite become the middle of the range.
void EncodeTexels(const float* maps, size_t texels, float* encoded);

// The inverse; `encoded` is clamped to [−1, 1] first.
void DecodeTexels(const float* encoded, size_t texels, float* maps);

// Given dL/d(maps) of the maps decoded from `encoded`, writes dL/d(encoded).
void DecodeTexelsAdjoint(const float* encoded, const float* maps_gradient, size_t texels,
                         float* encoded_gradient);

struct EncodedMaps {
  int width = 0;
  int height = 0;
  std::vector<float> planes;  // kEncodedChannels planes

  EncodedMaps() = default;
  EncodedMaps(int width_in, int height_in)
      : width(width_in),
        height(height_in),
        planes(static_cast<size_t>(kEncodedChannels) * width_in * height_in, 0.0f) {}
  size_t texels() const { return static_cast<size_t>(width) * height; }
};

EncodedMaps EncodeMaps(const SvbrdfMaps& maps);
SvbrdfMaps DecodeMaps(const EncodedMaps& encoded);

}  // namespace glint
