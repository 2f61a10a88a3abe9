#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "base/reflectance/log_radiance.h"
#include "base/reflectance/texel_at.h"
#include "fitting/texel/batch_kernel.h"
#include "fitting/texel/texel_albedos.h"
#include "tests/fitting/texel/random_lanes.h"

namespace glint {
namespace {

using kernel::BatchKernel;
using kernel::BatchSolution;
using kernel::Solving;
using test::Draw;
using test::kViews;
using test::Lanes;
using test::RandomTexel;
using test::Seen;
using test::Sets;
using Jet = ceres::Jet<double, kTexelParameters>;

// The photographs' residual written once more, for Ceres' automatic differentiation.
Jet AutodiffResidual(const Lanes& lanes, size_t lane, int v, int c, double* nearest_kink) {
  std::array<Jet, kTexelParameters> x;
  for (int i = 0; i < kTexelParameters; ++i) x[i] = Jet(lanes.texels[lane][i], i);
  const TexelSvbrdf<Jet> texel = TexelFromValues(x.data());
  const TexelGeometry<Jet> geometry = GeometryAs<Jet>(lanes.Geometry(lane, v));
  *nearest_kink = std::min(std::abs(Dot(texel.normal, geometry.light).a),
                           std::abs(Dot(texel.normal, geometry.camera).a));
  Jet radiance[3];
  ShadeRadiance(texel, geometry, lanes.Model(), radiance);
  const CharacteristicCurve& curve = lanes.options.curve;
  const RecordedRadiance<Jet> recorded = Recorded(radiance[c], curve.toe, curve.shoulder);
  if (recorded.slope.a < 2e-3) *nearest_kink = 0;  // the kernel leaves a thousandth
  Jet error = log(recorded.value + kLogOffset) - std::log(lanes.radiance[lane][v][c] + kLogOffset);
  if (lanes.clipped[lane][v][c]) {
    *nearest_kink = std::min(*nearest_kink, std::abs(error.a));
    if (error.a > 0.0) error = Jet(0.0);
  }
  const Jet scaled = error / lanes.options.robust_scale;
  return error * sqrt(2.0 / (1.0 + sqrt(1.0 + scaled * scaled)));
}

using Row = BatchResiduals::Row;

std::array<double, kTexelParameters> Derivatives(const BatchResiduals& residuals, int v, int c,
                                                 int lane) {
  std::array<double, kTexelParameters> by{};
  by[DiffuseParameter(c)] = residuals.at(v, c, Row::kByDiffuse, lane);
  by[SpecularParameter(c)] = residuals.at(v, c, Row::kBySpecular, lane);
  by[kRough] = residuals.at(v, c, Row::kByRough, lane);
  by[kSlopeX] = residuals.at(v, c, Row::kBySlopeX, lane);
  by[kSlopeY] = residuals.at(v, c, Row::kBySlopeY, lane);
  return by;
}

TexelGram GramOfLane(const BatchGram& batch, int lane) {
  TexelGram gram;
  for (auto& row : gram) row.fill(0.0);
  for (int c = 0; c < 3; ++c) {
    int next = 0;
    for (const int row : {DiffuseParameter(c), SpecularParameter(c)}) {
      auto& into = gram[static_cast<size_t>(row)];
      for (int column = row; column <= SpecularParameter(c); ++column) {
        into[static_cast<size_t>(column)] = batch.own[c][next++][lane];
      }
      for (size_t column = kRough; column < kGramSize; ++column) {
        into[column] = batch.own[c][next++][lane];
      }
    }
  }
  int next = 0;
  for (size_t row = kRough; row < kGramSize; ++row) {
    for (size_t column = row; column < kGramSize; ++column) {
      gram[row][column] = batch.shared[next++][lane];
    }
  }
  return gram;
}

TEST(BatchKernel, ResidualsAgreeWithAutodiffOfTheReflectanceModelAtAThousandPoints) {
  for (const InstructionSet set : Sets()) {
    std::mt19937 random(11);
    BatchResiduals residuals(kViews);
    BatchGram gram;
    for (int i = 0; i < 64; ++i) {
      Lanes lanes(&random);
      if (i % 5 == 1) lanes.SetLobes({0.6, 0.3});
      if (i % 5 == 2) lanes.SetLobes({0.4, 0.3, 0.05, 8});
      if (i % 5 == 3) lanes.SetLobes({.tail_exponent = 4});
      if (i % 5 == 4) lanes.SetLobes({0.4, 0.3, 0.05, 2, {1.8, 100}});
      if (i % 3 == 1) lanes.options.curve = {0.01, 0.2};
      if (i % 3 == 2) lanes.options.curve = {-0.004, -0.1};
      lanes.Observe();
      kernel::BatchKernelFor(set).gram(lanes.options, lanes.Views(), lanes.values, &gram,
                                       residuals.rows());
      for (size_t lane = 0; lane < kBatch; ++lane) {
        const int l = static_cast<int>(lane);
        for (int v = 0; v < kViews; ++v) {
          if (!lanes.observations.sees(v, l)) continue;
          for (int c = 0; c < 3; ++c) {
            double nearest_kink;
            const Jet expected = AutodiffResidual(lanes, lane, v, c, &nearest_kink);
            if (nearest_kink < 1e-4) continue;
            const double residual = residuals.at(v, c, Row::kResidual, l);
            ASSERT_NEAR(residual, expected.a, 3e-6 * (1.0 + std::abs(expected.a)))
                << Name(set) << " batch " << i << " lane " << lane;
            const double scale = expected.v.cwiseAbs().maxCoeff();
            const auto by = Derivatives(residuals, v, c, l);
            for (int p = 0; p < kTexelParameters; ++p) {
              ASSERT_NEAR(by[p], expected.v[p], 2e-5 * (scale + 1e-2))
                  << Name(set) << " batch " << i << " lane " << lane << " parameter " << p;
            }
          }
        }
      }
    }
  }
}

TEST(BatchKernel, ProductsAreThoseOfAllResiduals) {
  for (const InstructionSet set : Sets()) {
    std::mt19937 random(13);
    BatchResiduals residuals(kViews);
    BatchGram products;
    for (int i = 0; i < 10; ++i) {
      Lanes lanes(&random);
      lanes.Observe();
      kernel::BatchKernelFor(set).gram(lanes.options, lanes.Views(), lanes.values, &products,
                                       residuals.rows());
      for (int lane = 0; lane < kBatch; ++lane) {
        const TexelGram gram = GramOfLane(products, lane);
        const TexelGram expected = residuals.GramOf(lane, kViews);
        for (size_t a = 0; a < kGramSize; ++a) {
          for (size_t b = a; b < kGramSize; ++b) {
            const double size = std::sqrt(expected[a][a] * expected[b][b]);
            EXPECT_NEAR(gram[a][b], expected[a][b], 3e-6 * size);
          }
        }
      }
    }
  }
}

// Where a clipped pixel is satisfied the derivatives are nothing as well.
TEST(BatchKernel, SatisfiedClippingCostsNothing) {
  std::mt19937 random(14);
  Lanes lanes(&random);
  for (auto& of_lane : lanes.clipped) of_lane.fill({true, true, true});
  for (auto& of_lane : lanes.radiance) of_lane.fill({0, 0, 0});  // any rendering is brighter
  lanes.Observe();
  BatchGram gram;
  kernel::BatchKernelFor(BestInstructionSet())
      .gram(lanes.options, lanes.Views(), lanes.values, &gram, nullptr);
  for (int lane = 0; lane < kBatch; ++lane) {
    EXPECT_EQ(gram.Squares(lane), 0.0);
    const TexelGram products = GramOfLane(gram, lane);
    EXPECT_EQ(products[kRough][kRough], 0.0);
  }
}

TEST(BatchKernel, InverseIsThatOfTheNormalEquationsWithThePrior) {
  for (const InstructionSet set : Sets()) {
    std::mt19937 random(17);
    Lanes lanes(&random);
    lanes.Observe();
    const BatchKernel& kernel = kernel::BatchKernelFor(set);
    BatchGram photographs;
    BatchInverse inverse;
    kernel.gram(lanes.options, lanes.Views(), lanes.values, &photographs, nullptr);
    kernel.inverse(photographs, lanes.prior, lanes.values, 1e-3f, &inverse);
    for (int lane = 0; lane < kBatch; ++lane) {
      const size_t k = static_cast<size_t>(lane);

      TexelGram gram = GramOfLane(photographs, lane);
      lanes.priors[k].AddTo(lanes.texels[k], &gram);
      Eigen::Matrix<double, kTexelParameters, kTexelParameters> information;
      for (int i = 0; i < kTexelParameters; ++i) {
        for (int j = i; j < kTexelParameters; ++j) {
          information(i, j) = information(j, i) = gram[i][j];
        }
        information(i, i) += 1e-3;
      }
      const auto expected = information.inverse().eval();
      for (int i = 0; i < kTexelParameters; ++i) {
        for (int j = 0; j < kTexelParameters; ++j) {
          EXPECT_NEAR(inverse.at(i, j, lane), expected(i, j),
                      1e-3 * std::sqrt(expected(i, i) * expected(j, j)));
        }
      }
    }
  }
}

TEST(BatchKernel, FindsTheTexelsThatWerePhotographed) {
  Seen seen;
  const BatchSolution solution = seen.Solve(100);
  EXPECT_EQ(solution.converged, kernel::kAllLanes);
  for (int lane = 0; lane < kBatch; ++lane) {
    EXPECT_LT(solution.cost[lane], 1e-6 * solution.start_cost[lane]);
    const TexelValues found = ValuesOfLane(lane, solution.values);
    for (int p = 0; p < kTexelParameters; ++p) {
      EXPECT_NEAR(found[p], seen.truth[static_cast<size_t>(lane)][p], 5e-3) << "parameter " << p;
    }
  }
}

TEST(BatchKernel, SaysThatItDidNotConverge) {
  const BatchSolution stopped = Seen().Solve(2);
  EXPECT_EQ(stopped.converged, 0u);
  EXPECT_EQ(stopped.finished, kernel::kAllLanes);
  for (int lane = 0; lane < kBatch; ++lane) EXPECT_LT(stopped.cost[lane], stopped.start_cost[lane]);
}

TEST(BatchKernel, ALanesSolutionDoesNotDependOnTheOthers) {
  Seen seen;
  const BatchSolution all = seen.Solve(100);
  for (int lane = 0; lane < kBatch; ++lane) {
    const BatchSolution alone = seen.Solve(100, 1u << lane);
    EXPECT_EQ(ValuesOfLane(lane, alone.values), ValuesOfLane(lane, all.values)) << lane;
    EXPECT_EQ(alone.cost[lane], all.cost[lane]) << lane;
    EXPECT_EQ(alone.iterations[lane], all.iterations[lane]) << lane;
  }
}

// No value lowers the cost, those aside that lie where they bend toward their bounds.
TEST(BatchKernel, SolutionsAreMinimaOfThePosterior) {
  for (const InstructionSet set : Sets()) {
    std::mt19937 random(12);
    const BatchKernel& kernel = kernel::BatchKernelFor(set);
    for (int i = 0; i < 8; ++i) {
      Lanes lanes(&random);
      if (i % 5 == 1) lanes.SetLobes({0.5, 0.6});
      if (i % 5 == 2) lanes.SetLobes({0.5, 0.6, 0.05});
      if (i % 5 == 3) lanes.SetLobes({.tail_exponent = 4});
      if (i % 5 == 4) lanes.SetLobes({.anisotropy = {1.8, 100}});
      lanes.ShadeWith(lanes.texels);
      for (size_t lane = 0; lane < kBatch; ++lane) {
        for (auto& rgb : lanes.radiance[lane]) {
          for (double& radiance : rgb) radiance *= Draw(&random, 0.9, 1.1);
        }
        lanes.texels[lane] = RandomTexel(&random, 0.3);
      }
      lanes.Observe();
      BatchSolution solution;
      solution.values = lanes.values;
      kernel.solve(lanes.options, {.most_iterations = 400}, lanes.Views(), lanes.prior,
                   kernel::kAllLanes, Solving::kBegin, &solution);
      kernel.solve(lanes.options, {.most_iterations = 400}, lanes.Views(), lanes.prior,
                   ~solution.finished & kernel::kAllLanes, Solving::kFinish, &solution);
      const auto costs = [&](const BatchValues& values) {
        BatchGram gram;
        kernel.gram(lanes.options, lanes.Views(), values, &gram, nullptr);
        std::array<double, kBatch> all;
        for (int lane = 0; lane < kBatch; ++lane) {
          const size_t k = static_cast<size_t>(lane);
          all[k] =
              0.5 * (gram.Squares(lane) + lanes.priors[k].SquaredNorm(ValuesOfLane(lane, values)));
        }
        return all;
      };
      const auto least = costs(solution.values);
      for (int p = 0; p < kTexelParameters; ++p) {
        for (const double step : {-0.01, 0.01}) {
          BatchValues moved = solution.values;
          for (int lane = 0; lane < kBatch; ++lane) {
            moved.of[p][lane] += static_cast<float>(step);
          }
          const auto there = costs(moved);
          for (size_t lane = 0; lane < kBatch; ++lane) {
            EXPECT_NEAR(solution.cost[static_cast<int>(lane)], least[lane],
                        1e-5 * (1 + least[lane]));
            const double value = solution.values.of[p][static_cast<int>(lane)];
            // The wide lobe is as rough as can be: costs have a corner there.
            const double widest = solution.values.of[kRough][static_cast<int>(lane)] *
                                  static_cast<double>(lanes.options.mix.scale[0]);
            const bool at_bound = (p <= kRough && (value < 0.1 || value > 0.9)) ||
                                  (lanes.options.mix.two && std::abs(widest - 1) < 0.03);
            if (!(solution.converged >> lane & 1u) || at_bound) continue;
            EXPECT_GT(there[lane], least[lane] * (1 - 1e-5) - 1e-7)
                << Name(set) << " lane " << lane << " parameter " << p << " by " << step;
          }
        }
      }
    }
  }
}

std::vector<std::pair<InstructionSet, CharacteristicCurve>> SetsAndCurves() {
  std::vector<std::pair<InstructionSet, CharacteristicCurve>> all;
  for (const InstructionSet set : Sets()) {
    for (const CharacteristicCurve& curve :
         {CharacteristicCurve{}, {0.01, 0.2}, {-0.004, -0.1}, {0.03, 0}}) {
      all.emplace_back(set, curve);
    }
  }
  return all;
}

TEST(BatchKernel, AlbedoSumsLeadToTheAlbedosThatWerePhotographed) {
  for (const auto& [set, curve] : SetsAndCurves()) {
    Seen seen;
    seen.lanes.options.curve = curve;
    seen.lanes.ShadeWith(seen.truth);
    for (size_t lane = 0; lane < kBatch; ++lane) {
      for (int p = kRough; p < kTexelParameters; ++p) {
        seen.lanes.texels[lane][p] = seen.truth[lane][p];
      }
    }
    seen.lanes.Observe();
    BatchAlbedoSums sums;
    kernel::BatchKernelFor(set).albedo_sums(seen.lanes.options, seen.lanes.Views(),
                                            seen.lanes.values, &sums);
    const double prior_weights[kRough] = {};
    for (int lane = 0; lane < kBatch; ++lane) {
      const size_t k = static_cast<size_t>(lane);
      AlbedoSums of_lane[3];
      for (int c = 0; c < 3; ++c) of_lane[c] = sums.Of(c, lane);
      TexelValues texel = seen.lanes.texels[k];
      const AlbedoFit fit =
          FitAlbedos(of_lane, seen.lanes.options.diffuse_weight, prior_weights, texel, &texel);
      EXPECT_LT(fit.after, 1e-3 * fit.before);
      for (int p = 0; p < kRough; ++p) EXPECT_NEAR(texel[p], seen.truth[k][p], 5e-3);
    }
  }
}

}  // namespace
}  // namespace glint
