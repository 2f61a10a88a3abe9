#include "datasets/procedural/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace glint::procedural {
namespace {

struct Points {
  std::vector<float> x, y;
};

Points Line(int n, float x0, float y0, float dx, float dy) {
  Points p;
  for (int i = 0; i < n; ++i) {
    p.x.push_back(x0 + dx * static_cast<float>(i));
    p.y.push_back(y0 + dy * static_cast<float>(i));
  }
  return p;
}

std::vector<float> Noise(const NoiseOptions& options, const Points& p, float pixel) {
  std::vector<float> out(p.x.size());
  FractalNoise(options, p.x.data(), p.y.data(), static_cast<int>(p.x.size()), pixel, out.data());
  return out;
}

TEST(NoiseTest, SpreadIsOneThirdForAnyNumberOfOctaves) {
  const Points p = Line(40000, -50.0f, 31.0f, 0.0137f, 0.0091f);
  for (const int octaves : {1, 3, 6}) {
    const NoiseOptions options{NoiseKind::kSmooth, 5.0f, 1.0f, octaves, 0.5f, 2.03f, 9u};
    double sum = 0.0, square = 0.0;
    for (const float v : Noise(options, p, 1e-5f)) {
      sum += v;
      square += v * v;
    }
    EXPECT_NEAR(sum / 40000.0, 0.0, 0.02) << octaves;
    EXPECT_NEAR(std::sqrt(square / 40000.0), 0.333, 0.03) << octaves;
  }
}

TEST(NoiseTest, IsContinuousAcrossLatticeLines) {
  const Points p = Line(4000, -2.0f, -1.3f, 0.001f, 0.0007f);
  const NoiseOptions options{NoiseKind::kSmooth, 1.0f, 1.0f, 1, 0.5f, 2.03f, 4u};
  const std::vector<float> v = Noise(options, p, 1e-5f);
  for (size_t i = 1; i < v.size(); ++i) ASSERT_LT(std::fabs(v[i] - v[i - 1]), 0.01f) << i;
}

TEST(NoiseTest, OctavesFinerThanTexelsVanish) {
  const Points p = Line(500, 0.0f, 0.0f, 0.01f, 0.003f);
  const NoiseOptions options{NoiseKind::kSmooth, 100.0f, 1.0f, 3, 0.5f, 2.03f, 4u};
  const std::vector<float> coarse = Noise(options, p, 0.01f);
  EXPECT_EQ(*std::max_element(coarse.begin(), coarse.end()), 0.0f);
  const std::vector<float> fine = Noise(options, p, 0.0005f);
  EXPECT_GT(*std::max_element(fine.begin(), fine.end()), 0.3f);
}

TEST(NoiseTest, ValueDoesNotDependOnPlaceInTheRow) {
  const Points p = Line(67, -3.0f, 2.0f, 0.11f, -0.05f);
  const NoiseOptions options{NoiseKind::kRidged, 3.0f, 1.7f, 4, 0.5f, 2.03f, 8u};
  const std::vector<float> all = Noise(options, p, 1e-4f);
  for (size_t i = 0; i < all.size(); ++i) {  // vector lanes and remainders agree
    EXPECT_EQ(all[i], Noise(options, {{p.x[i]}, {p.y[i]}}, 1e-4f)[0]) << i;
  }
}

TEST(VoronoiTest, EdgeDistanceIsZeroWhereTheNearestSiteChanges) {
  const Points p = Line(20000, -4.0f, 1.0f, 0.0005f, 0.0002f);
  const int n = static_cast<int>(p.x.size());
  std::vector<float> dx(p.x.size()), dy(dx), edge(dx);
  std::vector<uint32_t> id(p.x.size());
  Voronoi(1.0f, 0.8f, 5u, p.x.data(), p.y.data(), n,
          {dx.data(), dy.data(), edge.data(), id.data()});
  int changes = 0;
  for (size_t i = 1; i < id.size(); ++i) {
    EXPECT_GE(edge[i], 0.0f);
    if (id[i] == id[i - 1]) continue;
    ++changes;
    EXPECT_LT(edge[i], 0.001f) << i;
    EXPECT_NEAR(std::hypot(dx[i], dy[i]), std::hypot(dx[i - 1], dy[i - 1]), 0.002f) << i;
  }
  EXPECT_GT(changes, 6);
}

}  // namespace
}  // namespace glint::procedural
