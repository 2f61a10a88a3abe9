// Heights from true normals, and from normals that refinement finds in photographs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fitting/relief/height_field.h"
#include "tests/fitting/refine/synthetic_scene.h"
#include "tests/fitting/relief/reliefs.h"

namespace glint {
namespace {

constexpr int kSize = 96;
constexpr int kPhotographs = 9;
constexpr double kHalfWidth_mm = 1;

SamplePlane Plane() {
  return {kSize, kSize, 2 * kHalfWidth_mm, 2 * kHalfWidth_mm, TexelSampling::kCornerToCorner};
}

// A satin lacquer with the relief's own normals.
SvbrdfMaps MapsOf(const test::Relief& relief) {
  constexpr double kStep = 1e-4;
  const SamplePlane plane = Plane();
  SvbrdfMaps maps(kSize, kSize);
  for (int i = 0; i < kSize * kSize; ++i) {
    const double x = plane.x_mm(i % kSize), y = plane.y_mm(i / kSize);
    const auto& h = relief.height_mm;
    const double slope_x = (h(x + kStep, y) - h(x - kStep, y)) / (2 * kStep);
    const double slope_y = (h(x, y + kStep) - h(x, y - kStep)) / (2 * kStep);
    const double length = std::hypot(slope_x, slope_y, 1.0);
    maps.plane(kNormalX)[i] = static_cast<float>(-slope_x / length);
    maps.plane(kNormalY)[i] = static_cast<float>(-slope_y / length);
    maps.plane(kNormalZ)[i] = static_cast<float>(1 / length);
    maps.plane(kRoughness)[i] = 0.35f;
    for (int c = 0; c < 3; ++c) {
      maps.plane(kDiffuseR + c)[i] = 0.3f - 0.05f * static_cast<float>(c);
      maps.plane(kSpecularR + c)[i] = 0.05f;
    }
  }
  return maps;
}

// RMS over the relief's range.
double Error(const test::Relief& relief, const HeightField& found) {
  const SamplePlane plane = Plane();
  std::vector<double> truth;
  double mean = 0;
  for (int i = 0; i < kSize * kSize; ++i) {
    truth.push_back(relief.height_mm(plane.x_mm(i % kSize), plane.y_mm(i / kSize)));
    mean += truth.back() / (kSize * kSize);
  }
  double squares = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    squares += std::pow(found.height_mm[i] - (truth[i] - mean), 2);
  }
  const auto [low, high] = std::minmax_element(truth.begin(), truth.end());
  return std::sqrt(squares / static_cast<double>(truth.size())) / (*high - *low);
}

class Reliefs : public testing::TestWithParam<test::Relief> {};

TEST_P(Reliefs, HeightsFromTrueAndFromFittedNormals) {
  const test::Relief& relief = GetParam();
  const SvbrdfMaps truth = MapsOf(relief);
  const double from_true = Error(relief, IntegrateNormals(truth, Plane()));
  const test::SyntheticScene scene = test::Photograph(truth, kPhotographs, 8);
  SvbrdfMaps start = truth;
  for (size_t i = 0; i < start.texels(); ++i) {
    start.plane(kNormalX)[i] = start.plane(kNormalY)[i] = 0;
    start.plane(kNormalZ)[i] = 1;
    start.plane(kRoughness)[i] = 0.5f;
  }
  const RefineResult fitted = Refine(scene.Problem(), start, RefineOptions{}, 2);
  const double from_fitted = Error(relief, IntegrateNormals(fitted.maps, Plane()));
  std::printf("%s: height RMS %.2f %% of the range from true normals, %.2f %% from fitted ones\n",
              relief.name.c_str(), 100 * from_true, 100 * from_fitted);
  EXPECT_LE(from_true, 0.03);
  EXPECT_LE(from_fitted, 0.10);
}

INSTANTIATE_TEST_SUITE_P(Five, Reliefs, testing::ValuesIn(test::Reliefs()),
                         [](const auto& relief) { return relief.param.name; });

}  // namespace
}  // namespace glint
