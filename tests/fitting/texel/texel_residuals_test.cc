#include "fitting/texel/texel_residuals.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "fitting/reflectance/texel_at.h"
#include "fitting/texel/texel_cholesky.h"
#include "fitting/texel/texel_cost.h"
#include "fitting/texel/texel_parameters.h"
#include "fitting/texel/texel_solver.h"

namespace glint {
namespace {

using Jet = ceres::Jet<double, kTexelParameters>;

struct Point {
  TexelValues texel;
  std::vector<TexelGeometry<double>> geometry;
  std::vector<std::array<double, 3>> radiance;
  std::vector<std::array<bool, 3>> clipped;
  KernelOptions options;
  TexelPrior prior;
};

double Draw(std::mt19937* random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(*random);
}

TexelValues RandomTexel(std::mt19937* random) {
  TexelValues texel;
  texel[kSlopeX] = Draw(random, -1.5, 1.5);
  texel[kSlopeY] = Draw(random, -1.5, 1.5);
  texel[kRough] = Draw(random, 0.05, 1.0);
  for (int c = 0; c < 3; ++c) {
    texel[DiffuseParameter(c)] = Draw(random, 0.0, 1.0);
    texel[SpecularParameter(c)] = Draw(random, 0.0, 1.0);
  }
  return texel;
}

Point RandomPoint(std::mt19937* random, int views) {
  Point point;
  point.texel = RandomTexel(random);
  point.options.robust_scale = Draw(random, 0.05, 1.0);
  point.options.diffuse_weight =
      Draw(random, 0, 1) < 0.5 ? DiffuseWeight::kOne : DiffuseWeight::kOneMinusSpecular;
  const double scale = Draw(random, 0.0, 0.1);
  point.prior = TexelPrior(TexelGaussian(RandomTexel(random), {}), scale);
  for (int v = 0; v < views; ++v) {
    View view;
    for (int i = 0; i < 2; ++i) {
      view.camera_in_sample_mm[i] = Draw(random, -200, 200);
      view.light_in_sample_mm[i] = Draw(random, -200, 200);
    }
    view.camera_in_sample_mm[2] = Draw(random, 150, 300);
    view.light_in_sample_mm[2] = Draw(random, 150, 300);
    for (int c = 0; c < 3; ++c) {
      view.light_rgb[c] = Draw(random, 5e4, 2e5);
      view.ambient_rgb[c] = Draw(random, 0, 0.1);
    }
    view.exposure = Draw(random, 0.5, 2);
    point.geometry.push_back(TexelGeometryInView<double>(
        view, LightFalloff::kInverseSquare, Draw(random, -50, 50), Draw(random, -50, 50)));
    point.radiance.push_back({Draw(random, 0, 1), Draw(random, 0, 1), Draw(random, 0, 1)});
    point.clipped.push_back({false, Draw(random, 0, 1) < 0.2, false});
  }
  return point;
}

void Fill(const Point& point, TexelObservations* observations) {
  observations->Clear();
  for (size_t v = 0; v < point.geometry.size(); ++v) {
    observations->Add(point.geometry[v], point.radiance[v].data(), point.clipped[v].data());
  }
  observations->Finish();
}

// The photographs' residuals written once more, for Ceres' automatic differentiation.
std::vector<Jet> AutodiffResiduals(const Point& point, double* nearest_kink) {
  std::array<Jet, kTexelParameters> x;
  for (int i = 0; i < kTexelParameters; ++i) x[i] = Jet(point.texel[i], i);
  const TexelSvbrdf<Jet> texel = TexelFromValues(x.data());
  std::vector<Jet> residuals;
  *nearest_kink = 1.0;
  for (size_t v = 0; v < point.geometry.size(); ++v) {
    const TexelGeometry<Jet> geometry = GeometryAs<Jet>(point.geometry[v]);
    const double dots[2] = {Dot(texel.normal, geometry.light).a,
                            Dot(texel.normal, geometry.camera).a};
    for (const double dot : dots) *nearest_kink = std::min(*nearest_kink, std::abs(dot));
    Jet radiance[3];
    ShadeRadiance(texel, geometry, point.options.diffuse_weight, radiance);
    for (int c = 0; c < 3; ++c) {
      Jet error = log(radiance[c] + kLogOffset) - std::log(point.radiance[v][c] + kLogOffset);
      if (point.clipped[v][c]) {
        *nearest_kink = std::min(*nearest_kink, std::abs(error.a));
        if (error.a > 0.0) error = Jet(0.0);
      }
      const Jet scaled = error / point.options.robust_scale;
      residuals.push_back(error * sqrt(2.0 / (1.0 + sqrt(1.0 + scaled * scaled))));
    }
  }
  return residuals;
}

TEST(TexelResiduals, AgreeWithAutodiffOfTheReflectanceModelAtAThousandPoints) {
  std::mt19937 random(11);
  constexpr int kViews = 5;
  TexelObservations observations(kViews);
  KernelRows rows(kViews);
  std::vector<double> residuals(3 * kViews + kTexelParameters);
  std::vector<double> jacobian(residuals.size() * kTexelParameters);
  for (int i = 0; i < 1000; ++i) {
    const Point point = RandomPoint(&random, kViews);
    Fill(point, &observations);
    EvaluateTexelResiduals(point.options, observations, point.prior, point.texel, &rows, residuals,
                           jacobian);
    double nearest_kink;
    const std::vector<Jet> expected = AutodiffResiduals(point, &nearest_kink);
    const double tolerance = nearest_kink < 1e-6 ? 1e-4 : 1e-6;
    for (size_t k = 0; k < expected.size(); ++k) {
      EXPECT_NEAR(residuals[k], expected[k].a, 1e-9 * (1.0 + std::abs(expected[k].a)));
      const double scale = expected[k].v.cwiseAbs().maxCoeff();
      for (int p = 0; p < kTexelParameters; ++p) {
        ASSERT_NEAR(jacobian[k * kTexelParameters + p], expected[k].v[p],
                    tolerance * (scale + 1e-3))
            << "point " << i << " residual " << k << " parameter " << p;
      }
    }
  }
}

// The variables' bounds and the prior are in the chain here: gradient of half the squares.
TEST(TexelCost, GradientAgreesWithFiniteDifferencesAtAThousandPoints) {
  std::mt19937 random(12);
  constexpr int kViews = 4;
  TexelObservations observations(kViews);
  KernelRows rows(kViews);
  for (int i = 0; i < 1000; ++i) {
    Point point = RandomPoint(&random, kViews);
    for (auto& clipped : point.clipped) clipped = {false, false, false};
    Fill(point, &observations);
    double variables[kTexelParameters];
    ToVariables(point.texel, variables);
    for (int p = 0; p <= kRough; ++p) variables[p] += Draw(&random, -0.1, 0.1);  // into the tails
    TexelGram gram;
    EvaluateCost(point.options, observations, point.prior, variables, &rows, &gram);
    double steepest = 0.0;
    for (int p = 0; p < kTexelParameters; ++p) {
      steepest = std::max(steepest, std::abs(gram[p][kTexelParameters]));
    }
    const double norm = std::sqrt(gram[kTexelParameters][kTexelParameters]);
    const auto half_squares = [&](int p, double step) {
      double moved[kTexelParameters];
      std::copy(variables, variables + kTexelParameters, moved);
      moved[p] += step;
      TexelGram there;
      EvaluateCost(point.options, observations, point.prior, moved, &rows, &there);
      return CostOf(there);
    };
    for (int p = 0; p < kTexelParameters; ++p) {
      // Fourth-order central difference; where a tail begins the second derivative jumps.
      const ValueBounds& bounds = p == kRough ? kRoughnessBounds : kAlbedoBounds;
      const bool beside =
          p <= kRough && (std::abs(variables[p] - bounds.low - bounds.tail) < 1e-3 ||
                          std::abs(variables[p] - bounds.high + bounds.tail) < 1e-3);
      const double h = beside ? 1e-5 : 2e-4;
      const double numeric = (8.0 * (half_squares(p, h) - half_squares(p, -h)) -
                              (half_squares(p, 2 * h) - half_squares(p, -2 * h))) /
                             (12.0 * h);
      ASSERT_NEAR(gram[p][kTexelParameters], numeric, (beside ? 1e-4 : 1e-6) * (steepest + norm))
          << "point " << i << " parameter " << p;
    }
  }
}

TEST(TexelCost, ProductsAreThoseOfAllResiduals) {
  std::mt19937 random(13);
  constexpr int kViews = 11;
  TexelObservations observations(kViews);
  KernelRows rows(kViews);
  const int count = 3 * kViews + kTexelParameters;
  for (int i = 0; i < 100; ++i) {
    Point point = RandomPoint(&random, kViews);
    for (int p = 0; p <= kRough; ++p) point.texel[p] = 0.2 + 0.6 * point.texel[p];  // no tails
    Fill(point, &observations);
    std::vector<double> all(count), derivatives(static_cast<size_t>(count) * kTexelParameters);
    EvaluateTexelResiduals(point.options, observations, point.prior, point.texel, &rows, all,
                           derivatives);
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, kTexelParameters, Eigen::RowMajor>;
    const Eigen::Map<const Rows> jacobian(derivatives.data(), count, kTexelParameters);
    const Eigen::Map<const Eigen::VectorXd> residuals(all.data(), count);

    double variables[kTexelParameters];
    ToVariables(point.texel, variables);
    TexelGram gram;
    EvaluateCost(point.options, observations, point.prior, variables, &rows, &gram);
    Eigen::MatrixXd all_columns(count, kGramSize);
    all_columns << jacobian, residuals;
    const Eigen::MatrixXd expected = all_columns.transpose() * all_columns;
    for (int a = 0; a < kGramSize; ++a) {
      for (int b = a; b < kGramSize; ++b) {
        const double size = std::sqrt(expected(a, a) * expected(b, b));
        EXPECT_NEAR(gram[a][b], expected(a, b), 1e-12 * size);
      }
    }
  }
}

// A matrix with the zeros of a texel's, plus damping: the solution satisfies it.
TEST(TexelCholesky, SolvesDampedNormalEquations) {
  std::mt19937 random(17);
  constexpr int kViews = 11;
  TexelObservations observations(kViews);
  KernelRows rows(kViews);
  for (int i = 0; i < 100; ++i) {
    const Point point = RandomPoint(&random, kViews);
    Fill(point, &observations);
    TexelGram gram;
    EvaluateGram(point.options, observations, point.texel, &rows, &gram);
    double damping[kTexelParameters], right[kTexelParameters], solution[kTexelParameters];
    for (int p = 0; p < kTexelParameters; ++p) {
      damping[p] = Draw(&random, 0.01, 1.0);
      right[p] = Draw(&random, -1.0, 1.0);
    }
    TexelCholesky(gram, damping).Solve(right, &solution);
    for (int p = 0; p < kTexelParameters; ++p) {
      double sum = damping[p] * solution[p], size = std::abs(right[p]);
      for (int q = 0; q < kTexelParameters; ++q) {
        sum += gram[std::min(p, q)][std::max(p, q)] * solution[q];
        size += std::abs(gram[std::min(p, q)][std::max(p, q)] * solution[q]);
      }
      EXPECT_NEAR(sum, right[p], 1e-11 * size);
    }
  }
}

// A texel seen without noise in twelve views, and a start beside it.
struct Seen {
  Seen() : observations(kViews) {
    std::mt19937 random(18);
    point = RandomPoint(&random, kViews);
    point.texel = {0.3, 0.1, 0.2, 0.1, 0.4, 0.1, 0.4, 0.1, -0.05};
    point.prior = TexelPrior();
    for (size_t v = 0; v < kViews; ++v) {
      ShadeRadiance(TexelFromValues(point.texel.data()), point.geometry[v],
                    point.options.diffuse_weight, point.radiance[v].data());
      point.clipped[v] = {false, false, false};
    }
    start = point.texel;
    for (int p = 0; p <= kRough; ++p) start[p] *= 1.3;
    start[kSlopeX] -= 0.1;
  }
  TexelSolution Solve(int most_iterations) {
    Fill(point, &observations);
    TexelSolver solver(point.options, most_iterations, kViews);
    return solver.Solve(observations, point.prior, start);
  }
  static constexpr int kViews = 12;
  Point point;
  TexelObservations observations;
  TexelValues start;
};

TEST(TexelSolver, FindsTheTexelThatWasPhotographed) {
  Seen seen;
  const TexelSolution solution = seen.Solve(100);
  EXPECT_TRUE(solution.converged);
  EXPECT_LT(solution.cost, 1e-8 * solution.start_cost);
  for (int p = 0; p < kTexelParameters; ++p) {
    EXPECT_NEAR(solution.values[p], seen.point.texel[p], 1e-3) << "parameter " << p;
  }
}

TEST(TexelSolver, SaysThatItDidNotConverge) {
  Seen seen;
  const TexelSolution stopped = seen.Solve(2);
  EXPECT_FALSE(stopped.converged);
  EXPECT_LT(stopped.cost, stopped.start_cost);
}

TEST(TexelKernel, SumsDoNotDependOnPaddingAndSatisfiedClippingCostsNothing) {
  std::mt19937 random(14);
  Point point = RandomPoint(&random, 3);
  for (auto& view : point.clipped) view = {true, true, true};
  for (auto& radiance : point.radiance) radiance = {0.0, 0.0, 0.0};  // any rendering is brighter
  TexelObservations observations(16);
  Fill(point, &observations);
  KernelRows rows(16);
  TexelGram gram;
  EvaluateGram(point.options, observations, point.texel, &rows, &gram);
  EXPECT_EQ(gram[kTexelParameters][kTexelParameters], 0.0);
  EXPECT_EQ(gram[kRough][kRough], 0.0);
}

TEST(TexelKernel, RobustResidualInverts) {
  for (const double e : {-3.0, -0.05, 0.0, 0.2, 4.0}) {
    const double s = std::sqrt(1.0 + e * e / 0.01);
    const double residual = e * std::sqrt(2.0 / (1.0 + s));
    double difference;
    LogDifferences(&residual, 1, 0.1, &difference);
    EXPECT_NEAR(difference, std::abs(e), 1e-12);
  }
}

TEST(TexelParameters, ValuesStayInsideTheirBoundsAndComeBack) {
  for (double u = -5.0; u < 5.0; u += 0.01) {
    double derivative;
    const double value = BoundedValue(kRoughnessBounds, u, &derivative);
    EXPECT_GE(value, kRoughnessBounds.low);
    EXPECT_LE(value, kRoughnessBounds.high);
    EXPECT_GT(derivative, 0.0);
    if (value > kRoughnessBounds.low + 0.01 && value < kRoughnessBounds.high - 0.01) {
      EXPECT_NEAR(UnboundedVariable(kRoughnessBounds, value), u, 1e-9);
    }
  }
}

TEST(TexelParameters, NormalsOf80DegreesSurviveAReadingAndWriting) {
  SvbrdfMaps maps(1, 1);
  const float tilt = 80.0f * 3.14159265f / 180.0f;
  maps.at(kNormalX, 0, 0) = std::sin(tilt);
  maps.at(kNormalZ, 0, 0) = std::cos(tilt);
  maps.at(kRoughness, 0, 0) = 0.5f;
  SvbrdfMaps back(1, 1);
  WriteTexel(ReadTexel(maps, 0), 0, &back);
  EXPECT_NEAR(back.at(kNormalX, 0, 0), maps.at(kNormalX, 0, 0), 1e-6);
  EXPECT_NEAR(back.at(kNormalZ, 0, 0), maps.at(kNormalZ, 0, 0), 1e-6);
}

}  // namespace
}  // namespace glint
