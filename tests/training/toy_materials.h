// Small materials with structure, so that tests need no generator, and a training on them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/reflectance/svbrdf_maps.h"
#include "training/random.h"
#include "training/train_options.h"

namespace glint {

// Two substances in waves over a bumpy ground; everything drawn from `k`.
inline SvbrdfMaps ToyMaterial(std::uint64_t k, int width, int height) {
  Stream random(StreamSeed(77, k));
  SvbrdfMaps maps(width, height);
  const double fx = random.Uniform(-0.3, 0.3), fy = random.Uniform(-0.3, 0.3);
  const double bump = random.Uniform(0.0, 0.6), phase = random.Uniform(0, 6);
  double a[7], b[7];
  for (int c = 0; c < 7; ++c) a[c] = random.Uniform(0.05, 0.9), b[c] = random.Uniform(0.05, 0.9);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double u = fx * column + fy * row + phase;
      const double s = 1.0 / (1.0 + std::exp(-6.0 * std::sin(u)));
      for (int c = 0; c < 7; ++c) {
        maps.at(kDiffuseR + c, row, column) = static_cast<float>(s * a[c] + (1 - s) * b[c]);
      }
      const double sx = bump * std::cos(u), sy = bump * std::cos(2 * u);
      const double z = 1.0 / std::sqrt(1 + sx * sx + sy * sy);
      maps.at(kNormalX, row, column) = static_cast<float>(sx * z);
      maps.at(kNormalY, row, column) = static_cast<float>(sy * z);
      maps.at(kNormalZ, row, column) = static_cast<float>(z);
    }
  }
  return maps;
}

// Those that tests train on, and those they never train on.
inline SvbrdfMaps Toy(std::uint64_t k) { return ToyMaterial(k, 64, 64); }
inline SvbrdfMaps Unseen(std::uint64_t k) { return ToyMaterial(k + 1'000'000, 64, 64); }

// A training of seconds on Toy(); Options: TrainOptions or derived from them.
template <class Options>
Options TinyTraining(std::int64_t steps) {
  Options options;
  options.steps = steps;
  options.batch = 4;
  options.crops = {32};
  options.learning_rate = 3e-3;
  options.warmup_steps = 10;
  options.render_views = 1;
  options.pool.material_size = 64;
  options.pool.window = 32;
  options.pool.first = 8;
  options.pool.per_step = 0.2;
  options.bf16 = false;
  return options;
}

}  // namespace glint
