#include "datasets/evaluation/light_interpolation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "tests/calib/moving_light/lights_on_a_dome.h"

namespace glint {
namespace {

using LightFunction = std::function<double(const Eigen::Vector3d& light)>;

const LightInterpolation& Method(const std::string& name) {
  for (const LightInterpolation& method : LightInterpolations()) {
    if (method.name == name) return method;
  }
  throw std::runtime_error("no method " + name);
}

// Largest error of a function that is known under 40 lights, at `wanted`.
double LargestError(const std::string& method, const LightFunction& f,
                    const std::vector<Eigen::Vector3d>& wanted) {
  const auto known = testing::LightsOnADome(40);
  const Eigen::MatrixXd weights = Method(method).weights(known, wanted);
  double largest = 0;
  for (size_t i = 0; i < wanted.size(); ++i) {
    double sum = 0;
    for (size_t j = 0; j < known.size(); ++j) {
      sum += weights(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * f(known[j]);
    }
    largest = std::max(largest, std::abs(sum - f(wanted[i])));
  }
  return largest;
}

double ErrorElsewhere(const std::string& method, const LightFunction& f) {
  return LargestError(method, f, testing::LightsOnADome(17, 20, 75));
}

double Quadratic(const Eigen::Vector3d& l) {
  return 0.3 + 2 * l.x() - l.y() + 3 * l.x() * l.y() + 0.5 * l.x() * l.x() - l.y() * l.y();
}
double SecondDegree(const Eigen::Vector3d& l) {
  return Quadratic(l) + 2 * l.z() + l.x() * l.z() - 3 * l.y() * l.z();
}
double ThirdDegree(const Eigen::Vector3d& l) {
  return SecondDegree(l) + l.x() * l.y() * l.z() - 2 * l.x() * l.x() * l.x() +
         l.y() * l.y() * l.z();
}

TEST(LightInterpolation, KnowsFourMethods) {
  std::vector<std::string> names;
  for (const LightInterpolation& method : LightInterpolations()) names.push_back(method.name);
  EXPECT_EQ(names, (std::vector<std::string>{"ptm", "sh9", "sh16", "rbf"}));
}

TEST(LightInterpolation, RowsAreNewLightsAndTheirWeightsSumToOne) {
  const auto known = testing::LightsOnADome(30), wanted = testing::LightsOnADome(7, 25, 70);
  for (const LightInterpolation& method : LightInterpolations()) {
    const Eigen::MatrixXd weights = method.weights(known, wanted);
    ASSERT_EQ(weights.rows(), 7) << method.name;
    ASSERT_EQ(weights.cols(), 30) << method.name;
    for (Eigen::Index i = 0; i < 7; ++i) EXPECT_NEAR(weights.row(i).sum(), 1, 1e-9) << method.name;
  }
}

TEST(LightInterpolation, PtmReproducesQuadraticsOfTheLightsXAndY) {
  EXPECT_LT(ErrorElsewhere("ptm", Quadratic), 1e-9);
  EXPECT_GT(ErrorElsewhere("ptm", SecondDegree), 1e-2);
}

TEST(LightInterpolation, HarmonicsReproducePolynomialsOfTheirDegree) {
  EXPECT_LT(ErrorElsewhere("sh9", SecondDegree), 1e-9);
  EXPECT_GT(ErrorElsewhere("sh9", ThirdDegree), 1e-2);
  EXPECT_LT(ErrorElsewhere("sh16", ThirdDegree), 1e-9);
}

TEST(LightInterpolation, SplinesGoThroughThePhotographsWhateverTheyShow) {
  const auto highlight = [](const Eigen::Vector3d& l) { return std::exp(80 * (l.z() - 1)); };
  EXPECT_LT(LargestError("rbf", highlight, testing::LightsOnADome(40)), 1e-9);
  EXPECT_GT(LargestError("ptm", highlight, testing::LightsOnADome(40)), 1e-2);
}

TEST(LightInterpolation, SplinesReproduceAffineFunctions) {
  EXPECT_LT(ErrorElsewhere("rbf", [](const Eigen::Vector3d& l) { return 1 + 2 * l.x() - l.y(); }),
            1e-9);
}

TEST(LightInterpolation, FewerPhotographsThanTermsAreStillGoneThrough) {
  const auto known = testing::LightsOnADome(5);
  for (const LightInterpolation& method : LightInterpolations()) {
    const Eigen::MatrixXd weights = method.weights(known, known);
    EXPECT_LT((weights - Eigen::MatrixXd::Identity(5, 5)).norm(), 1e-8) << method.name;
  }
}

}  // namespace
}  // namespace glint
