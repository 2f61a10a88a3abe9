#include "training/material_pool.h"

#include <gtest/gtest.h>

#include "fitting/encoding/encoding.h"
#include "tests/training/toy_materials.h"

namespace glint {
namespace {

PoolOptions Small() {
  PoolOptions options;
  options.material_size = 64;
  options.window = 8;
  options.first = 3;
  options.per_step = 0.5;
  options.seed = 9;
  return options;
}

std::vector<float> Batch(MaterialPool* pool, std::int64_t step) {
  std::vector<float> batch(2 * kEncodedChannels * 32 * 32);
  pool->Sample(step, 2, 32, batch);
  return batch;
}

TEST(MaterialPool, AResumedPoolGivesTheSameSamples) {
  MaterialPool whole(Small(), Toy, 0);
  std::vector<std::vector<float>> batches;
  for (int step = 0; step < 40; ++step) batches.push_back(Batch(&whole, step));
  MaterialPool resumed(Small(), Toy, 30);
  for (int step = 30; step < 40; ++step) EXPECT_EQ(Batch(&resumed, step), batches[step]) << step;
  EXPECT_NE(batches[0], batches[1]);
}

// A relief whose height is its colour: whatever mirror or turn a sample has, normals must lean
// down the slope of the colours.
SvbrdfMaps Relief(std::uint64_t k) {
  Stream random(StreamSeed(4, k));
  const double fx = random.Uniform(0.05, 0.2), fy = random.Uniform(0.05, 0.2);
  const double phase = random.Uniform(0, 6);
  SvbrdfMaps maps(64, 64);
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 64; ++column) {
      const double u = fx * column - 0.5 * fy * row + phase, v = fy * row + phase;
      const double height = 0.5 + 0.2 * std::sin(u) + 0.2 * std::sin(v);
      const double dx = 0.2 * fx * std::cos(u);
      const double dy = -(-0.1 * fy * std::cos(u) + 0.2 * fy * std::cos(v));  // y runs against rows
      const double z = 1 / std::sqrt(1 + dx * dx + dy * dy);
      maps.at(kNormalX, row, column) = static_cast<float>(-dx * z);
      maps.at(kNormalY, row, column) = static_cast<float>(-dy * z);
      maps.at(kNormalZ, row, column) = static_cast<float>(z);
      for (int c = 0; c < 3; ++c) {
        maps.at(kDiffuseR + c, row, column) = static_cast<float>(height * height);
      }
      maps.at(kRoughness, row, column) = 0.5f;
    }
  }
  return maps;
}

TEST(MaterialPool, MirrorsAndTurnsTakeTheNormalsAlong) {
  MaterialPool pool(Small(), Relief, 0);
  const int n = 32, count = 40;
  std::vector<float> batch(static_cast<size_t>(count) * kEncodedChannels * n * n);
  pool.Sample(0, count, n, batch);
  for (int k = 0; k < count; ++k) {
    const float* maps = batch.data() + static_cast<size_t>(k) * kEncodedChannels * n * n;
    const auto at = [&](int plane, int row, int column) {
      return double{maps[(plane * n + row) * n + column]};
    };
    double along = 0, slopes = 0, normals = 0;
    for (int row = 1; row + 1 < n; ++row) {
      for (int column = 1; column + 1 < n; ++column) {
        const double dx = at(0, row, column + 1) - at(0, row, column - 1);
        const double dy = at(0, row - 1, column) - at(0, row + 1, column);
        const double nx = at(kEncodedNormal, row, column), ny = at(kEncodedNormal + 1, row, column);
        along -= dx * nx + dy * ny;
        slopes += dx * dx + dy * dy;
        normals += nx * nx + ny * ny;
      }
    }
    EXPECT_GT(along / std::sqrt(slopes * normals), 0.9) << k;
  }
}

TEST(MaterialPool, AFailingSourceIsReported) {
  MaterialPool pool(
      Small(), [](std::uint64_t) -> SvbrdfMaps { throw std::runtime_error("no"); }, 0);
  EXPECT_THROW(Batch(&pool, 0), std::runtime_error);
}

}  // namespace
}  // namespace glint
