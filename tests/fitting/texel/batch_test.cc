#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "fitting/reflectance/log_radiance.h"
#include "fitting/reflectance/texel_at.h"
#include "fitting/texel/batch_kernel.h"
#include "fitting/texel/batch_search.h"
#include "fitting/texel/texel_albedos.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

using kernel::BatchKernel;
using kernel::BatchSolution;
using kernel::Solving;
using Jet = ceres::Jet<double, kTexelParameters>;

constexpr int kViews = 7;

std::vector<InstructionSet> Sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (Available(set)) sets.push_back(set);
  }
  return sets;
}

double Draw(std::mt19937* random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(*random);
}

TexelValues RandomTexel(std::mt19937* random, double steepest) {
  TexelValues texel;
  texel[kSlopeX] = Draw(random, -steepest, steepest);
  texel[kSlopeY] = Draw(random, -steepest, steepest);
  texel[kRough] = Draw(random, 0.1, 1.0);
  for (int c = 0; c < 3; ++c) {
    texel[DiffuseParameter(c)] = Draw(random, 0.0, 1.0);
    texel[SpecularParameter(c)] = Draw(random, 0.0, 1.0);
  }
  return texel;
}

// A texel in each lane, under the same views.
struct Lanes {
  explicit Lanes(std::mt19937* random)
      : observations(kViews), scratch(kViews * kernel::BatchViews::kScratchRows) {
    options.robust_scale = Draw(random, 0.05, 1.0);
    options.diffuse_weight =
        Draw(random, 0, 1) < 0.5 ? DiffuseWeight::kOne : DiffuseWeight::kOneMinusSpecular;
    for (View& view : views) view = RandomView(random);
    const double scale = Draw(random, 0.01, 0.1);
    for (size_t lane = 0; lane < kBatch; ++lane) {
      place_mm[lane] = {Draw(random, -50, 50), Draw(random, -50, 50)};
      texels[lane] = RandomTexel(random, 0.6);
      priors[lane] =
          TexelPrior(TexelGaussian(RandomTexel(random, 0.6), InitialisationErrors()), scale);
      for (int v = 0; v < kViews; ++v) {
        for (int c = 0; c < 3; ++c) radiance[lane][v][c] = Draw(random, 0, 1);
        clipped[lane][v] = {false, Draw(random, 0, 1) < 0.2, false};
      }
    }
  }

  void SetLobes(const SpecularLobes& of_sample) {
    lobes = of_sample;
    options.mix = LobeMixOf<float>(lobes);
  }

  static View RandomView(std::mt19937* random) {
    View view;
    for (size_t i = 0; i < 2; ++i) {
      view.camera_in_sample_mm[i] = Draw(random, -100, 100);
      view.light_in_sample_mm[i] = Draw(random, -100, 100);
      view.beam[i] = Draw(random, -0.3, 0.3);
    }
    view.camera_in_sample_mm[2] = Draw(random, 150, 300);
    view.light_in_sample_mm[2] = Draw(random, 150, 300);
    for (size_t c = 0; c < 3; ++c) {
      view.light_rgb[c] = Draw(random, 5e4, 2e5);
      view.ambient_rgb[c] = Draw(random, 0, 0.1);
    }
    view.exposure = Draw(random, 0.5, 2);
    return view;
  }

  TexelGeometry<double> Geometry(size_t lane, int v) const {
    return TexelGeometryInView<double>(views[static_cast<size_t>(v)], LightFalloff::kInverseSquare,
                                       place_mm[lane][0], place_mm[lane][1]);
  }

  void ShadeWith(const std::array<TexelValues, kBatch>& shown) {
    for (size_t lane = 0; lane < kBatch; ++lane) {
      for (int v = 0; v < kViews; ++v) {
        ShadeRadiance(TexelFromValues(shown[lane].data()), Geometry(lane, v), Model(),
                      radiance[lane][v].data());
        clipped[lane][v] = {false, false, false};
      }
    }
  }

  void Observe() {
    observations.Clear(kViews);
    for (size_t lane = 0; lane < kBatch; ++lane) {
      const int l = static_cast<int>(lane);
      observations.Place(l, place_mm[lane][0], place_mm[lane][1]);
      SetLane(l, texels[lane], &values);
      prior.SetLane(l, priors[lane]);
      for (int v = 0; v < kViews; ++v) {
        if (lane == 3 && v == 2) continue;  // masked there
        const auto& r = radiance[lane][v];
        const float seen[3] = {static_cast<float>(r[0]), static_cast<float>(r[1]),
                               static_cast<float>(r[2])};
        observations.Set(l, v, seen, clipped[lane][v].data());
      }
    }
    for (int v = 0; v < kViews; ++v) {
      observations.Complete(v,
                            BatchView(views[static_cast<size_t>(v)], LightFalloff::kInverseSquare));
    }
  }

  ReflectanceConvention Model() const {
    ReflectanceConvention model;
    model.diffuse_weight = options.diffuse_weight;
    model.lobes = lobes;
    return model;
  }

  kernel::BatchViews Views() { return {observations.rows(), kViews, scratch.data()}; }

  BatchObservations observations;
  BatchValues values;
  BatchPrior prior;
  KernelOptions options;
  SpecularLobes lobes;
  std::vector<BatchRow> scratch;
  std::array<std::array<double, 2>, kBatch> place_mm;
  std::array<View, kViews> views;
  std::array<TexelValues, kBatch> texels;
  std::array<TexelPrior, kBatch> priors;
  std::array<std::array<std::array<double, 3>, kViews>, kBatch> radiance;
  std::array<std::array<std::array<bool, 3>, kViews>, kBatch> clipped;
};

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
  Jet error = log(radiance[c] + kLogOffset) - std::log(lanes.radiance[lane][v][c] + kLogOffset);
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
      if (i % 2 == 1) lanes.SetLobes({0.6, 0.3});
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

// Texels seen without noise, and starts beside them.
struct Seen {
  Seen() : random(18), lanes(&random) {
    lanes.texels.fill({0.3, 0.1, 0.2, 0.1, 0.4, 0.1, 0.4, 0.1, -0.05});
    for (size_t lane = 0; lane < kBatch; ++lane) {
      lanes.texels[lane][kRough] = 0.25 + 0.02 * static_cast<double>(lane);
    }
    truth = lanes.texels;
    lanes.ShadeWith(truth);
    lanes.priors.fill(TexelPrior());
    for (TexelValues& texel : lanes.texels) {
      for (int p = 0; p <= kRough; ++p) texel[p] *= 1.3;
      texel[kSlopeX] -= 0.1;
    }
    lanes.Observe();
  }
  BatchSolution Solve(int most_iterations, kernel::LaneBits active = kernel::kAllLanes) {
    BatchSolution solution;
    solution.values = lanes.values;
    const BatchKernel& kernel = kernel::BatchKernelFor(BestInstructionSet());
    const kernel::SolveOptions solve{.most_iterations = most_iterations};
    kernel.solve(lanes.options, solve, lanes.Views(), lanes.prior, active, Solving::kBegin,
                 &solution);
    kernel.solve(lanes.options, solve, lanes.Views(), lanes.prior, active & ~solution.finished,
                 Solving::kFinish, &solution);
    return solution;
  }
  std::mt19937 random;
  Lanes lanes;
  std::array<TexelValues, kBatch> truth;
};

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
      if (i % 2 == 1) lanes.SetLobes({0.5, 0.6});
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

TEST(BatchKernel, AlbedoSumsLeadToTheAlbedosThatWerePhotographed) {
  for (const InstructionSet set : Sets()) {
    Seen seen;
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

// Gives the lanes' observations of these ids, which may repeat.
BatchSearch::Gather GatherFrom(const BatchObservations& all) {
  return [&all](std::span<const size_t> ids, BatchObservations* observations) {
    observations->Clear(kViews);
    for (size_t i = 0; i < ids.size(); ++i) {
      observations->CopyLane(all, static_cast<int>(ids[i] % kBatch), static_cast<int>(i));
    }
    return observations;
  };
}

TEST(BatchSearch, EveryTaskIsDoneWhateverTheirNumber) {
  Seen seen;
  BatchSearch search(seen.lanes.options, 40, kViews, 2);
  search.SetNoise(0.01);
  for (const size_t count : {1, 16, 37, 100}) {
    std::vector<int> done(count, 0);
    search.Begin(BatchSearch::From::kStart, GatherFrom(seen.lanes.observations),
                 [&](const BatchSearch::Task& task, const BatchSearch::Found& found) {
                   ++done[task.id];
                   EXPECT_LE(found.solution.cost, found.solution.start_cost);
                   EXPECT_NEAR(found.solution.values[kRough], seen.truth[task.id % kBatch][kRough],
                               5e-3);
                 });
    for (size_t id = 0; id < count; ++id) {
      search.Add({.id = id, .prior = {}, .start = seen.lanes.texels[id % kBatch]});
    }
    search.Finish();
    EXPECT_EQ(done, std::vector<int>(count, 1));
  }
}

// Of `rounds` · kBatch texels that `draw` makes, how many the search does not find from `start`.
int Misses(
    int rounds, const std::function<TexelValues(std::mt19937*)>& draw, const TexelValues& start,
    const TexelPrior& prior,
    const std::function<bool(const TexelValues& found, const TexelValues& truth)>& is_found) {
  std::mt19937 random(7);
  int missed = 0;
  for (int round = 0; round < rounds; ++round) {
    Lanes lanes(&random);
    lanes.options = {};
    std::array<TexelValues, kBatch> truth;
    for (TexelValues& texel : truth) texel = draw(&random);
    lanes.ShadeWith(truth);
    lanes.Observe();
    BatchSearch search(lanes.options, 40, kViews, 3);
    search.SetNoise(0.003);
    search.Begin(BatchSearch::From::kStart, GatherFrom(lanes.observations),
                 [&](const BatchSearch::Task& task, const BatchSearch::Found& found) {
                   if (!is_found(found.solution.values, truth[task.id])) ++missed;
                 });
    for (size_t id = 0; id < kBatch; ++id) {
      search.Add({.id = id, .prior = prior, .start = start});
    }
    search.Finish();
  }
  return missed;
}

TexelValues GreyTexel(double diffuse, double specular, double rough, double slope_x,
                      double slope_y) {
  TexelValues texel;
  for (int c = 0; c < 3; ++c) {
    texel[DiffuseParameter(c)] = diffuse;
    texel[SpecularParameter(c)] = specular;
  }
  texel[kRough] = rough;
  texel[kSlopeX] = slope_x;
  texel[kSlopeY] = slope_y;
  return texel;
}

// From a level start steep matte texels come to lie in a minimum without diffuse light, whose wide
// specular lobe explains the shading.
TEST(BatchSearch, SteepMatteTexelsAreFoundFromALevelStart) {
  constexpr int kRounds = 60;
  const auto steep = [](std::mt19937* random) {
    const double tilt = Draw(random, 1.2, 1.8), azimuth = Draw(random, 0, 6.28);
    return GreyTexel(0.3, 0.04, 0.6, tilt * std::cos(azimuth), tilt * std::sin(azimuth));
  };
  const auto same_normal = [](const TexelValues& found, const TexelValues& truth) {
    return std::hypot(found[kSlopeX] - truth[kSlopeX], found[kSlopeY] - truth[kSlopeY]) < 0.1;
  };
  EXPECT_LT(Misses(kRounds, steep, GreyTexel(0.05, 0.3, 0.8, 0, 0), {}, same_normal),
            0.05 * kRounds * kBatch);
}

// On the flank of a highlight a dark and rough texel explains what a smooth one shows, and from
// there other roughnesses alone lead nowhere.
TEST(BatchSearch, TexelsLikeTheOthersOfTheirSubstanceAreFoundFromAPoorStart) {
  constexpr int kRounds = 60;
  const auto smooth = [](std::mt19937* random) {
    return GreyTexel(0.04, 0.045, Draw(random, 0.13, 0.2), Draw(random, -0.02, 0.02),
                     Draw(random, -0.02, 0.02));
  };
  const auto same_roughness = [](const TexelValues& found, const TexelValues& truth) {
    return std::abs(std::log(found[kRough] / truth[kRough])) < 0.2;
  };
  const TexelPrior of_substance(
      TexelGaussian(GreyTexel(0.045, 0.045, 0.165, 0, 0), InitialisationErrors()), 0.003);
  EXPECT_LT(Misses(kRounds, smooth, GreyTexel(0.02, 0.045, 0.7, 0.05, -0.05), of_substance,
                   same_roughness),
            0.02 * kRounds * kBatch);
}

TEST(TexelParameters, ValuesStayInsideTheirBoundsAndComeBack) {
  for (int i = -500; i < 500; ++i) {
    const double u = 0.01 * i;
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
