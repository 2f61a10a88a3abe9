#include "datasets/synth/sensor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors/errors.h"
#include "datasets/procedural/random.h"

namespace glint {
namespace {

// Sum of four uniform numbers (Irwin–Hall), scaled to variance 1: within ±3.5, close to normal, and
// one hash instead of a logarithm and a cosine.
float NearlyNormal(std::uint64_t bits) {
  const float sum = static_cast<float>((bits & 0xffff) + ((bits >> 16) & 0xffff) +
                                       ((bits >> 32) & 0xffff) + (bits >> 48));
  return (sum / 65536.0f - 2.0f + 2.0f / 65536.0f) * 1.7320508f;
}

}  // namespace

float NoisyRadiance(float radiance, const SensorNoise& noise, std::uint64_t seed,
                    std::uint64_t sample) {
  if (noise.scale <= 0) return radiance;
  const float full_well = static_cast<float>(noise.full_well_electrons);
  const float read = static_cast<float>(noise.read_electrons);
  const float sigma = std::sqrt(std::max(radiance, 0.0f) * full_well + read * read) / full_well;
  const std::uint64_t bits = procedural::Mix64(seed ^ procedural::Mix64(sample));
  return radiance + static_cast<float>(noise.scale) * sigma * NearlyNormal(bits);
}

void BlurRows(const std::vector<float>& rgb, int width, int rows, double sigma_px,
              std::vector<float>* blurred) {
  const auto side =
      static_cast<float>(0.5 * sigma_px * sigma_px);  // variance of the kernel: 2·side
  const float middle = 1 - 2 * side;
  const size_t stride = 3 * static_cast<size_t>(width);
  blurred->resize(stride * (rows - 2));
  std::vector<float> column(stride);
  for (int row = 1; row + 1 < rows; ++row) {
    const float* at = rgb.data() + row * stride;
    for (size_t i = 0; i < stride; ++i) {
      column[i] =
          middle * at[i] +
          side * (at[static_cast<ptrdiff_t>(i) - static_cast<ptrdiff_t>(stride)] + at[i + stride]);
    }
    float* out = blurred->data() + (row - 1) * stride;
    for (size_t i = 0; i < stride; ++i) {
      const float left = column[i >= 3 ? i - 3 : i];
      const float right = column[i + 3 < stride ? i + 3 : i];
      out[i] = middle * column[i] + side * (left + right);
    }
  }
}

Encoding ParseEncoding(const std::string& name) {
  if (const auto encoding = EncodingFromName(name)) return *encoding;
  throw UserError("encoding: found \"" + name + "\"; use gamma2.2, srgb or linear");
}

EightBitEncoder::EightBitEncoder(Encoding encoding) : first_code_(kCells + 1) {
  for (int code = 1; code <= 255; ++code) {
    threshold_[code] = LinearFromEncoded(encoding, (static_cast<float>(code) - 0.5f) / 255.0f);
  }
  threshold_[256] = std::numeric_limits<float>::infinity();
  int code = 0;
  for (int cell = 0; cell <= kCells; ++cell) {
    const float root = static_cast<float>(cell) / kCells;
    // A little early, so that rounding in operator() cannot start past the answer.
    while (code < 255 && threshold_[code + 1] < root * root * (1 - 1e-5f)) ++code;
    first_code_[cell] = static_cast<unsigned char>(code);
  }
}

unsigned char EightBitEncoder::operator()(float linear) const {
  if (!(linear > 0.0f)) return 0;
  if (linear >= 1.0f) return 255;
  int code = first_code_[static_cast<int>(std::sqrt(linear) * kCells)];
  while (linear >= threshold_[code + 1]) ++code;
  return static_cast<unsigned char>(code);
}

}  // namespace glint
