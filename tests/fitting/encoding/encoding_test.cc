#include "fitting/encoding/encoding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/training/toy_materials.h"

namespace glint {
namespace {

double TiltDegrees(const SvbrdfMaps& maps, size_t i) {
  return std::acos(maps.plane(kNormalZ)[i]) * 180.0 / 3.14159265358979;
}

TEST(Encoding, RoundTripKeepsTheMaps) {
  const SvbrdfMaps maps = ToyMaterial(3, 37, 21);
  const SvbrdfMaps back = DecodeMaps(EncodeMaps(maps));
  for (size_t i = 0; i < maps.planes.size(); ++i) {
    EXPECT_NEAR(back.planes[i], maps.planes[i], 2e-6) << i;
  }
}

TEST(Encoding, StaysWithinTheRangeOfTanh) {
  SvbrdfMaps maps(4, 1);
  maps.planes = {
      0, 1,  0, 0.99999f, 0, 0,  -1, 0,  1, 0,  0, 0,  // normals: up, along x, along −y, grazing
      0, 1,  2, -1,       0, 1,  2,  -1, 0, 1,  2, -1, 0, 1,
      2, -1, 0, 1,        2, -1, 0,  1,  2, -1, 0, 1,  2, -1};
  for (const float t : EncodeMaps(maps).planes) {
    EXPECT_GE(t, -1.0f);
    EXPECT_LE(t, 1.0f);
  }
}

TEST(Encoding, ValuesThatAreNotFiniteBecomeFinite) {
  SvbrdfMaps maps(2, 1);
  for (float& x : maps.planes) x = std::numeric_limits<float>::quiet_NaN();
  maps.planes[3] = std::numeric_limits<float>::infinity();
  for (const float t : EncodeMaps(maps).planes) EXPECT_TRUE(std::isfinite(t));
}

TEST(Encoding, NormalsReachSeventyFiveDegreesInEveryDirection) {
  const int directions = 16;
  EncodedMaps encoded(directions, 1);
  for (int i = 0; i < directions; ++i) {
    const double angle = 2 * 3.14159265358979 * i / directions;
    // Onto the rim of the square [−1, 1]².
    const double rim = 1 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
    encoded.planes[kEncodedNormal * directions + i] = static_cast<float>(rim * std::cos(angle));
    encoded.planes[(kEncodedNormal + 1) * directions + i] =
        static_cast<float>(rim * std::sin(angle));
  }
  const SvbrdfMaps maps = DecodeMaps(encoded);
  for (int i = 0; i < directions; ++i) EXPECT_GE(TiltDegrees(maps, i), 75.0) << i;
}

TEST(Encoding, SteepNormalsComeBack) {
  SvbrdfMaps maps(3, 1);
  for (int i = 0; i < 3; ++i) {
    const double tilt = (i + 1) * 25.0 * 3.14159265358979 / 180;
    maps.at(kNormalX, 0, i) = static_cast<float>(-std::sin(tilt));
    maps.at(kNormalZ, 0, i) = static_cast<float>(std::cos(tilt));
  }
  const SvbrdfMaps back = DecodeMaps(EncodeMaps(maps));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(back.at(kNormalX, 0, i), maps.at(kNormalX, 0, i), 1e-5);
    EXPECT_NEAR(back.at(kNormalZ, 0, i), maps.at(kNormalZ, 0, i), 1e-5);
  }
}

TEST(Encoding, AdjointAgreesWithFiniteDifferences) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> inside(-0.9f, 0.9f);
  for (int trial = 0; trial < 200; ++trial) {
    float encoded[kEncodedChannels], weights[kSvbrdfPlanes], gradient[kEncodedChannels];
    for (float& t : encoded) t = inside(random);
    for (float& w : weights) w = inside(random);
    DecodeTexelsAdjoint(encoded, weights, 1, gradient);
    for (int k = 0; k < kEncodedChannels; ++k) {
      double side[2];
      const float step = 1e-2f;
      for (int s = 0; s < 2; ++s) {
        float moved[kEncodedChannels], maps[kSvbrdfPlanes];
        std::copy(encoded, encoded + kEncodedChannels, moved);
        moved[k] += s == 0 ? -step : step;
        DecodeTexels(moved, 1, maps);
        side[s] = 0;
        for (int p = 0; p < kSvbrdfPlanes; ++p) side[s] += double{weights[p]} * maps[p];
      }
      EXPECT_NEAR(gradient[k], (side[1] - side[0]) / (2.0 * step), 2e-3) << trial << " " << k;
    }
  }
}

}  // namespace
}  // namespace glint
