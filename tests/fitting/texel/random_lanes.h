// Random texels in the lanes of a batch, under random views: what its kernels and its search are
// tested on.
#pragma once

#include <array>
#include <random>
#include <vector>

#include "base/reflectance/brdf.h"
#include "fitting/texel/batch_kernel.h"
#include "fitting/texel/texel_parameters.h"

namespace glint::test {

inline constexpr int kViews = 7;

inline std::vector<InstructionSet> Sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (Available(set)) sets.push_back(set);
  }
  return sets;
}

inline double Draw(std::mt19937* random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(*random);
}

inline TexelValues RandomTexel(std::mt19937* random, double steepest) {
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
        for (double& r : radiance[lane][v]) {
          r = Recorded(r, options.curve.toe, options.curve.shoulder).value;
        }
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
  kernel::BatchSolution Solve(int most_iterations, kernel::LaneBits active = kernel::kAllLanes) {
    kernel::BatchSolution solution;
    solution.values = lanes.values;
    const kernel::BatchKernel& kernel = kernel::BatchKernelFor(BestInstructionSet());
    const kernel::SolveOptions solve{.most_iterations = most_iterations};
    kernel.solve(lanes.options, solve, lanes.Views(), lanes.prior, active, kernel::Solving::kBegin,
                 &solution);
    kernel.solve(lanes.options, solve, lanes.Views(), lanes.prior, active & ~solution.finished,
                 kernel::Solving::kFinish, &solution);
    return solution;
  }
  std::mt19937 random;
  Lanes lanes;
  std::array<TexelValues, kBatch> truth;
};

}  // namespace glint::test
