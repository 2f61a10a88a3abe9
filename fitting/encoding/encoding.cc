#include "fitting/encoding/encoding.h"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

float Finite(float x, float otherwise) { return std::isfinite(x) ? x : otherwise; }

float EncodeColour(float c) { return 2.0f * std::sqrt(std::clamp(c, 0.0f, 1.0f)) - 1.0f; }

// Solves t + 3·t³ = s. With t = ⅔·sinh u the left side is (2/9)·sinh 3u.
float EncodeSlope(float slope) {
  const float s = std::clamp(slope, -kMaxSlope, kMaxSlope);
  return std::clamp(2.0f / 3.0f * std::sinh(std::asinh(4.5f * s) / 3.0f), -1.0f, 1.0f);
}

float DecodeSlope(float t) { return t * (1.0f + 3.0f * t * t); }

float Clamped(float t) { return std::min(1.0f, std::max(-1.0f, t)); }

}  // namespace

void EncodeTexels(const float* maps, size_t texels, float* encoded) {
  for (int c = 0; c < 6; ++c) {  // diffuse, then specular: planes 3…8 of the maps
    const float* from = maps + (kDiffuseR + c) * texels;
    float* to = encoded + c * texels;
    for (size_t i = 0; i < texels; ++i) to[i] = EncodeColour(Finite(from[i], 0.25f));
  }
  const float* roughness = maps + kRoughness * texels;
  float* to = encoded + kEncodedRoughness * texels;
  for (size_t i = 0; i < texels; ++i) {
    const float u = (Finite(roughness[i], 0.5f) - kMinRoughness) / (1.0f - kMinRoughness);
    to[i] = 2.0f * std::clamp(u, 0.0f, 1.0f) - 1.0f;
  }
  const float* nz = maps + kNormalZ * texels;
  for (int axis = 0; axis < 2; ++axis) {
    const float* n = maps + (kNormalX + axis) * texels;
    float* slope = encoded + (kEncodedNormal + axis) * texels;
    for (size_t i = 0; i < texels; ++i) {
      slope[i] = EncodeSlope(Finite(n[i] / std::max(nz[i], 1e-3f), 0.0f));
    }
  }
}

void DecodeTexels(const float* encoded, size_t texels, float* maps) {
  for (int c = 0; c < 6; ++c) {
    const float* from = encoded + c * texels;
    float* to = maps + (kDiffuseR + c) * texels;
    for (size_t i = 0; i < texels; ++i) {
      const float u = 0.5f * (Clamped(from[i]) + 1.0f);
      to[i] = u * u;
    }
  }
  const float* r = encoded + kEncodedRoughness * texels;
  float* roughness = maps + kRoughness * texels;
  for (size_t i = 0; i < texels; ++i) {
    roughness[i] = kMinRoughness + (1.0f - kMinRoughness) * 0.5f * (Clamped(r[i]) + 1.0f);
  }
  const float* tx = encoded + kEncodedNormal * texels;
  const float* ty = tx + texels;
  float* n = maps + kNormalX * texels;
  for (size_t i = 0; i < texels; ++i) {
    const float x = DecodeSlope(Clamped(tx[i])), y = DecodeSlope(Clamped(ty[i]));
    const float z = 1.0f / std::sqrt(x * x + y * y + 1.0f);
    n[i] = x * z;
    n[i + texels] = y * z;
    n[i + 2 * texels] = z;
  }
}

void DecodeTexelsAdjoint(const float* encoded, const float* maps_gradient, size_t texels,
                         float* encoded_gradient) {
  for (int c = 0; c < 6; ++c) {
    const float* t = encoded + c * texels;
    const float* g = maps_gradient + (kDiffuseR + c) * texels;
    float* out = encoded_gradient + c * texels;
    for (size_t i = 0; i < texels; ++i) out[i] = g[i] * 0.5f * (Clamped(t[i]) + 1.0f);
  }
  const float* g_roughness = maps_gradient + kRoughness * texels;
  float* out_roughness = encoded_gradient + kEncodedRoughness * texels;
  for (size_t i = 0; i < texels; ++i) {
    out_roughness[i] = g_roughness[i] * 0.5f * (1.0f - kMinRoughness);
  }
  const float* tx = encoded + kEncodedNormal * texels;
  const float* ty = tx + texels;
  const float* g = maps_gradient + kNormalX * texels;
  float* out_x = encoded_gradient + kEncodedNormal * texels;
  float* out_y = out_x + texels;
  for (size_t i = 0; i < texels; ++i) {
    const float a = Clamped(tx[i]), b = Clamped(ty[i]);
    const float x = DecodeSlope(a), y = DecodeSlope(b);
    const float z = 1.0f / std::sqrt(x * x + y * y + 1.0f);
    // n = (x, y, 1)·z, dz/dx = −x·z³: dL/dx = z·(g_x − n_x·(n·g)).
    const float gx = g[i], gy = g[i + texels], gz = g[i + 2 * texels];
    const float along = z * (x * gx + y * gy + gz);
    out_x[i] = z * (gx - x * z * along) * (1.0f + 9.0f * a * a);
    out_y[i] = z * (gy - y * z * along) * (1.0f + 9.0f * b * b);
  }
}

EncodedMaps EncodeMaps(const SvbrdfMaps& maps) {
  EncodedMaps encoded(maps.width, maps.height);
  EncodeTexels(maps.planes.data(), maps.texels(), encoded.planes.data());
  return encoded;
}

SvbrdfMaps DecodeMaps(const EncodedMaps& encoded) {
  SvbrdfMaps maps(encoded.width, encoded.height);
  DecodeTexels(encoded.planes.data(), encoded.texels(), maps.planes.data());
  return maps;
}

}  // namespace glint
