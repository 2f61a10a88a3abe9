#include "calib/light/spot_cost.h"

#include <ceres/jet.h>

namespace glint::light {
namespace {

enum Block { kFlash, kLogQ, kAmbient, kVignetting, kGloss, kSmear, kTone, kExposure };

// The flash's light on a spot, and its derivatives by flash_mm and gloss.
using Flash = ceres::Jet<double, 4>;

bool FlashOf(const SpotGeometry& geometry, const double* flash_mm, double gloss, Flash* flash) {
  const Flash place[3] = {Flash(flash_mm[0], 0), Flash(flash_mm[1], 1), Flash(flash_mm[2], 2)};
  return FlashOnSpot(geometry, place, Flash(gloss, 3), flash);
}

// Ceres' Jacobians of the blocks, each of three rows: those that are held are null.
class Rows {
 public:
  explicit Rows(double** jacobians) : jacobians_(jacobians) {}
  // By number `i` of the `size` of a block.
  void Set(Block block, int size, int channel, int i, double derivative) const {
    if (jacobians_[block] != nullptr) jacobians_[block][size * channel + i] = derivative;
  }
  // Of a block that has a number for each channel.
  void SetOwn(Block block, int channel, double derivative) const {
    for (int i = 0; i < 3; ++i) Set(block, 3, channel, i, i == channel ? derivative : 0);
  }

 private:
  double** jacobians_;
};

}  // namespace

bool SpotCost::Evaluate(const double* const* blocks, double* residual, double** jacobians) const {
  const SpotGeometry& geometry = spot_.geometry;
  double radiance[3];
  if (!Predict(geometry, reference_, blocks[kFlash], blocks[kLogQ], blocks[kAmbient],
               blocks[kVignetting], blocks[kGloss], blocks[kSmear], blocks[kTone],
               blocks[kExposure], radiance)) {
    return false;
  }
  for (int c = 0; c < 3; ++c) {
    residual[c] = (spot_.seen[c] - radiance[c]) / (spot_.sigma[c] * scale_);
  }
  if (jacobians == nullptr) return true;
  Flash flash;
  FlashOf(geometry, blocks[kFlash], blocks[kGloss][0], &flash);
  const double falloff = Falloff(geometry, blocks[kVignetting]);
  const double clear = 1 - blocks[kSmear][0] * geometry.smear;
  const Rows rows(jacobians);
  for (int c = 0; c < 3; ++c) {
    const double light = flash.a + blocks[kAmbient][c] * reference_;
    const double x = std::log(falloff * clear * light) + blocks[kExposure][c] + blocks[kLogQ][c];
    const double by_log_toned = -radiance[c] / (spot_.sigma[c] * scale_);
    const double by_log = by_log_toned * TonedSlope(blocks[kTone], x);
    for (int i = 0; i < 3; ++i) rows.Set(kFlash, 3, c, i, by_log * flash.v[i] / light);
    rows.Set(kGloss, 1, c, 0, by_log * flash.v[3] / light);
    rows.SetOwn(kAmbient, c, by_log * reference_ / light);
    rows.SetOwn(kLogQ, c, by_log);
    rows.SetOwn(kExposure, c, by_log);
    rows.Set(kSmear, 1, c, 0, -by_log * geometry.smear / clear);
    double power_of_r2 = 1, power_of_x = 1;
    for (int i = 0; i < 3; ++i) {
      rows.Set(kVignetting, 3, c, i, by_log * (power_of_r2 *= geometry.r2) / falloff);
      rows.Set(kTone, 3, c, i, by_log_toned * (power_of_x *= x));
    }
  }
  return true;
}

}  // namespace glint::light
