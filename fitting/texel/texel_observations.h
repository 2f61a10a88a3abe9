// What one texel's residuals need from the photographs, laid out for vector units.
#pragma once

#include <vector>

#include "fitting/reflectance/brdf.h"
#include "fitting/reflectance/log_radiance.h"

namespace glint {

// Views are handled eight at a time, whatever the processor: sums then have one order, and so one
// result, on all of them.
inline constexpr int kLanes = 8;

// Linear radiance from which a photograph that clips is taken to be at its limit; resampling may
// have mixed a little of a darker pixel in (see AdmitClippedTexels).
inline constexpr double kClipped = 0.99;

// Structure of arrays over the usable views of one texel, padded to a multiple of kLanes by views
// of weight 0. One object per thread serves all its texels; memory is fixed by the constructor.
class TexelObservations {
 public:
  enum Plane : int {
    kLightX,  // unit, texel to light
    kLightY,
    kLightZ,
    kCameraX,  // unit, texel to camera
    kCameraY,
    kCameraZ,
    kHalfX,
    kHalfY,
    kHalfZ,
    kFresnel,               // the power of two in F
    kIrradiance,            // 3 planes: exposure·E
    kAmbient = 13,          // 3 planes: exposure·ambient, as the diffuse lobe receives it …
    kAmbientSpecular = 16,  // … 3 planes: and as the specular one does
    kLogTarget = 19,        // 3 planes: log(I + 0.01)
    kCeiling = 22,  // 3 planes: most the residual log(R + 0.01) − log(I + 0.01) can be; 0 where
                    // the photograph clips, so that a brighter rendering satisfies it
    kWeight = 25,   // square root of the weight of the view's squared residuals
    kInverseTarget = 26,  // 3 planes: 1/(I + 0.01)
    kPlanes = 29
  };

  explicit TexelObservations(int most_views);

  void Clear() { views_ = 0; }
  // `radiance` linear, ≥ 0; `clipped`: the sensor's limit was reached in that channel.
  void Add(const TexelGeometry<double>& geometry, const double radiance[3], const bool clipped[3],
           double weight = 1.0);
  // Pads to whole lanes; after the last Add.
  void Finish();

  int views() const { return views_; }
  int padded_views() const { return padded_; }
  const double* plane(int p) const { return samples_ + static_cast<size_t>(p) * stride_; }

 private:
  double* plane(int p) { return samples_ + static_cast<size_t>(p) * stride_; }

  int most_views_;
  int stride_;
  int views_ = 0;
  int padded_ = 0;
  std::vector<double> storage_;
  double* samples_;  // 64-byte aligned, inside storage_

 public:
  TexelObservations(const TexelObservations&) = delete;
  TexelObservations& operator=(const TexelObservations&) = delete;
};

}  // namespace glint
