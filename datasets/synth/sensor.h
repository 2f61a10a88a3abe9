// What a phone's sensor and its software do to radiance: noise, clipping, tone curve, 8 bits.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/linearize/encoding.h"

namespace glint {

// Photon and read noise of a pixel that clips at radiance 1: standard deviation
// sqrt(radiance·full_well + read²) / full_well, electrons.
struct SensorNoise {
  double full_well_electrons = 8000;
  double read_electrons = 4;
  double scale = 1;  // 0: no noise
};

// One draw of the sensor, a function of (seed, sample) alone: `sample` numbers pixel and channel.
float NoisyRadiance(float radiance, const SensorNoise& noise, std::uint64_t seed,
                    std::uint64_t sample);

inline constexpr double kMostBlur_px = 0.8;

// Blurs rows [1, rows − 1) of `rgb` (interleaved, `rows` × `width` pixels) into `blurred`, rows − 2
// rows, with the three-tap kernel of standard deviation `sigma_px` ≤ kMostBlur_px along both axes.
// The first and last pixel of a row count twice.
void BlurRows(const std::vector<float>& rgb, int width, int rows, double sigma_px,
              std::vector<float>* blurred);

// Encoding by name: "gamma2.2", "srgb", "linear", as in capture.toml. Throws UserError.
Encoding ParseEncoding(const std::string& name);

// Rounds encoded radiance to 8 bits, exactly, without a power per sample: the table only has to
// find the right neighbourhood of the 255 thresholds in linear radiance.
class EightBitEncoder {
 public:
  explicit EightBitEncoder(Encoding encoding);
  unsigned char operator()(float linear) const;

 private:
  static constexpr int kCells = 4096;  // over the square root of radiance
  std::array<float, 257> threshold_{};
  std::vector<unsigned char> first_code_;
};

}  // namespace glint
