#include "fitting/texel/texel_observations.h"

#include <cassert>
#include <cmath>
#include <cstdint>

#include "fitting/texel/texel_kernel.h"

namespace glint {
namespace {

constexpr double kNoCeiling = 1e30;

int RoundUpToLanes(int views) { return (views + kLanes - 1) / kLanes * kLanes; }

}  // namespace

TexelObservations::TexelObservations(int most_views)
    : most_views_(most_views), stride_(RoundUpToLanes(most_views)) {
  constexpr std::uintptr_t kAlignment = kLanes * sizeof(double);
  storage_.assign(static_cast<size_t>(kPlanes) * stride_ + kLanes, 0.0);
  const auto address = reinterpret_cast<std::uintptr_t>(storage_.data());
  const std::uintptr_t aligned = (address + kAlignment - 1) / kAlignment * kAlignment;
  samples_ = storage_.data() + (aligned - address) / sizeof(double);
}

void TexelObservations::Add(const TexelGeometry<double>& geometry, const double radiance[3],
                            const bool clipped[3], double weight) {
  assert(views_ < most_views_);
  const int v = views_++;
  for (int i = 0; i < 3; ++i) {
    plane(kLightX + i)[v] = geometry.light[i];
    plane(kCameraX + i)[v] = geometry.camera[i];
    plane(kHalfX + i)[v] = geometry.half[i];
    plane(kIrradiance + i)[v] = geometry.irradiance[i];
    plane(kAmbient + i)[v] = geometry.ambient[i];
    plane(kAmbientSpecular + i)[v] = geometry.ambient_specular[i];
    plane(kLogTarget + i)[v] = radiance[i] + kLogOffset;
    plane(kCeiling + i)[v] = clipped[i] ? 0.0 : kNoCeiling;
  }
  plane(kFresnel)[v] = geometry.fresnel;
  plane(kWeight)[v] = std::sqrt(weight);
}

void TexelObservations::Finish() {
  padded_ = RoundUpToLanes(views_);
  for (int v = views_; v < padded_; ++v) {
    for (int p = 0; p < kPlanes; ++p) plane(p)[v] = 0.0;
    // Any geometry that keeps the arithmetic finite.
    plane(kLightZ)[v] = plane(kCameraZ)[v] = plane(kHalfZ)[v] = 1.0;
    for (int c = 0; c < 3; ++c) plane(kLogTarget + c)[v] = 1.0;
  }
  for (int c = 0; c < 3; ++c) {
    TakeLogarithms(padded_, plane(kLogTarget + c), plane(kInverseTarget + c));
  }
}

}  // namespace glint
