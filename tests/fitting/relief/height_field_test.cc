#include "fitting/relief/height_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace glint {
namespace {

// A smooth relief of some tenths of a millimetre, on a sample of 20 mm.
HeightField Waves(int width, int height) {
  HeightField field{width, height, 20.0 / width, 20.0 / height, {}};
  double mean = 0;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double x = 20.0 * column / width, y = 20.0 * row / height;
      field.height_mm.push_back(static_cast<float>(0.3 * std::sin(0.9 * x + 0.4 * y) +
                                                   0.2 * std::cos(0.7 * y) + 0.01 * x));
      mean += field.height_mm.back() / (static_cast<double>(width) * height);
    }
  }
  for (float& h : field.height_mm) h -= static_cast<float>(mean);
  return field;
}

SvbrdfMaps MapsOf(const HeightField& field) {
  SvbrdfMaps maps(field.width, field.height);
  const std::vector<float> normals = NormalsOf(field);
  std::copy(normals.begin(), normals.end(), maps.planes.begin());
  return maps;
}

class HeightFieldSizes : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(HeightFieldSizes, NormalsOfAReliefIntegrateToIt) {
  const auto [width, height] = GetParam();
  const HeightField truth = Waves(width, height);
  const HeightField found =
      IntegrateNormals(MapsOf(truth), {width, height, 20, 20, TexelSampling::kPixelCentres});
  ASSERT_EQ(found.height_mm.size(), truth.height_mm.size());
  EXPECT_NEAR(found.texel_x_mm, 20.0 / width, 1e-9);
  double squares = 0;
  for (size_t i = 0; i < truth.height_mm.size(); ++i) {
    squares += std::pow(found.height_mm[i] - truth.height_mm[i], 2);
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(truth.height_mm.size())), 0.005);
}

INSTANTIATE_TEST_SUITE_P(EvenAndOdd, HeightFieldSizes,
                         testing::Values(std::pair{64, 64}, std::pair{63, 80}, std::pair{81, 65}));

// Waves of 2 mm stay what they are, a bowl as wide as the sample goes.
TEST(HeightField, ScreeningFlattensWhatIsLong) {
  const auto relief = [](double fine, double bowl) {
    HeightField field{128, 128, 20.0 / 128, 20.0 / 128, {}};
    for (int i = 0; i < 128 * 128; ++i) {
      const double x = 20.0 * (i % 128) / 128, t = x / 20;
      field.height_mm.push_back(
          static_cast<float>(fine * std::sin(2 * M_PI * x / 2) + bowl * std::cos(M_PI * t)));
    }
    return field;
  };
  const auto rms = [](const HeightField& field) {
    double squares = 0;
    for (const float h : field.height_mm) squares += h * h / (128.0 * 128.0);
    return std::sqrt(squares);
  };
  const SamplePlane plane{128, 128, 20, 20, TexelSampling::kPixelCentres};
  const auto integrated = [&](double fine, double bowl) {
    return IntegrateNormals(MapsOf(relief(fine, bowl)), plane, 6);
  };
  EXPECT_NEAR(rms(integrated(0.1, 0)), rms(relief(0.1, 0)), 0.2 * rms(relief(0.1, 0)));
  EXPECT_LT(rms(integrated(0, 0.1)), 0.05 * rms(relief(0, 0.1)));
}

double DifferenceRms(const HeightField& a, const HeightField& b) {
  double squares = 0;
  for (size_t i = 0; i < a.height_mm.size(); ++i) {
    squares += std::pow(a.height_mm[i] - b.height_mm[i], 2);
  }
  return std::sqrt(squares / static_cast<double>(a.height_mm.size()));
}

TEST(HeightField, EqualTrustChangesNothing) {
  const HeightField truth = Waves(63, 80);
  const SamplePlane plane{63, 80, 20, 20, TexelSampling::kPixelCentres};
  const std::vector<float> same(63 * 80, 0.7f);
  EXPECT_LT(DifferenceRms(IntegrateNormals(MapsOf(truth), plane, 0, same),
                          IntegrateNormals(MapsOf(truth), plane)),
            1e-5);
}

// Where normals are known to be bad, what is around them decides.
TEST(HeightField, NormalsThatAreNotTrustedBendLessOfTheRelief) {
  const HeightField truth = Waves(64, 64);
  SvbrdfMaps maps = MapsOf(truth);
  std::vector<float> sigma(maps.texels(), 0.01f);
  for (int row = 10; row < 54; ++row) {
    for (int column = 24; column < 36; ++column) {  // a stripe that leans as a whole
      const size_t i = static_cast<size_t>(row) * 64 + static_cast<size_t>(column);
      maps.plane(kNormalX)[i] += 0.3f;
      sigma[i] = 0.3f;
    }
  }
  const SamplePlane plane{64, 64, 20, 20, TexelSampling::kPixelCentres};
  const double even = DifferenceRms(IntegrateNormals(maps, plane), truth);
  const double trusting =
      DifferenceRms(IntegrateNormals(maps, plane, 0, TrustOfNormals(sigma, sigma)), truth);
  EXPECT_LT(trusting, 0.25 * even);
  EXPECT_THROW(IntegrateNormals(maps, plane, 0, std::vector<float>(3, 1.0f)),
               std::invalid_argument);
}

TEST(HeightField, DoesNotDependOnTheNumberOfThreads) {
  SvbrdfMaps maps(50, 70);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(-0.3f, 0.3f);
  for (size_t i = 0; i < maps.texels(); ++i) {
    maps.plane(kNormalX)[i] = uniform(random);
    maps.plane(kNormalY)[i] = uniform(random);
    maps.plane(kNormalZ)[i] = 0.9f;
  }
  std::vector<float> trust(maps.texels());
  for (float& t : trust) t = 1 + uniform(random);
  const SamplePlane plane{50, 70, 50, 70, TexelSampling::kPixelCentres};
  EXPECT_EQ(IntegrateNormals(maps, plane, 9, trust, 1).height_mm,
            IntegrateNormals(maps, plane, 9, trust, 3).height_mm);
}

TEST(HeightField, AFlatSampleIsFlat) {
  SvbrdfMaps maps(9, 7);
  for (float& z : maps.plane(kNormalZ)) z = 1;
  const HeightField field = IntegrateNormals(maps, {9, 7, 9, 7, TexelSampling::kPixelCentres});
  for (const float h : field.height_mm) EXPECT_EQ(h, 0.0f);
}

TEST(HeightField, BrokenNormalsStayFinite) {
  SvbrdfMaps maps(16, 16);
  maps.plane(kNormalX)[40] = 1;  // normals of length 0 elsewhere
  for (const float h :
       IntegrateNormals(maps, {16, 16, 16, 16, TexelSampling::kPixelCentres}).height_mm) {
    EXPECT_TRUE(std::isfinite(h));
  }
}

TEST(HeightField, LookupIsBilinear) {
  const HeightField field{2, 2, 1, 1, {0, 1, 2, 3}};
  EXPECT_NEAR(field.Lookup(0.5, 0.5), 1.5, 1e-9);
  EXPECT_NEAR(field.Lookup(-3, 9), 1, 1e-9);
}

}  // namespace
}  // namespace glint
