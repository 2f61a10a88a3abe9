// Refinement against one bounded ceres::Solve per texel: the same texels, starts and residuals (20
// views of 8 bit, robust, with the prior), one thread, one process. Prints texels per second, the
// ratio and both mean costs. Refinement's time is all of it: several starts, neighbours, confidence.
#include <ceres/ceres.h>
#include <fmt/format.h>
#include <time.h>

#include <cmath>
#include <random>
#include <vector>

#include "fitting/refine/gather.h"
#include "fitting/refine/refine.h"
#include "fitting/refine/refine_prior.h"
#include "fitting/refine/texel_parameters.h"
#include "fitting/refine/texel_residuals.h"

namespace glint {
namespace {

constexpr int kSize = 64;
constexpr int kViews = 20;

// CPU time of this thread: other work on the machine does not count.
double Now() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Patches of one material each, with noise over them; the start is off in everything.
struct Scene {
  SvbrdfMaps start{kSize, kSize};
  std::vector<View> views;
  std::vector<std::vector<float>> photographs;
  std::vector<float> mask = std::vector<float>(kSize * kSize, 1.0f);
  RefineProblem problem;
};

TexelValues RandomMaterial(std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto draw = [&] { return uniform(*random); };
  TexelValues texel{};
  texel[kRough] = 0.15 + 0.6 * draw();
  const double diffuse = 0.03 + 0.5 * draw(), specular = 0.03 + 0.2 * draw() * draw();
  for (int c = 0; c < 3; ++c) {
    texel[DiffuseParameter(c)] = diffuse * (0.5 + 0.5 * draw());
    texel[SpecularParameter(c)] = specular;
  }
  return texel;
}

void Photograph(const SvbrdfMaps& truth, Scene* scene) {
  const size_t texels = truth.texels();
  for (const View& view : scene->views) {
    std::vector<float> rgb(3 * texels);
    for (size_t t = 0; t < texels; ++t) {
      TexelSvbrdf<double> texel;
      for (int i = 0; i < 3; ++i) {
        texel.normal[i] = truth.plane(kNormalX + i)[t];
        texel.diffuse[i] = truth.plane(kDiffuseR + i)[t];
        texel.specular[i] = truth.plane(kSpecularR + i)[t];
      }
      texel.roughness = truth.plane(kRoughness)[t];
      double radiance[3];
      ShadeRadiance(texel,
                    TexelGeometryInView<double>(view, LightFalloff::kNone,
                                                scene->problem.plane.x_mm(int(t % kSize)),
                                                scene->problem.plane.y_mm(int(t / kSize))),
                    DiffuseWeight::kOne, radiance);
      for (int c = 0; c < 3; ++c) {
        const double level = std::round(255.0 * std::pow(std::fmin(radiance[c], 1.0), 1.0 / 2.2));
        rgb[c * texels + t] = static_cast<float>(std::pow(level / 255.0, 2.2));
      }
    }
    scene->photographs.push_back(std::move(rgb));
  }
}

void MakeScene(Scene* scene) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto draw = [&] { return uniform(random); };
  scene->problem.plane = {kSize, kSize, 2.0, 2.0, TexelSampling::kCornerToCorner};
  scene->problem.convention = ReflectanceConvention::Dir2019();
  for (int i = 0; i < kViews; ++i) {
    scene->views.push_back(DirView(i ? kDirJitter * draw() : 0.0, i ? kDirJitter * draw() : 0.0));
  }
  SvbrdfMaps truth(kSize, kSize);
  constexpr int kPatch = 16;
  std::vector<TexelValues> materials;
  for (int i = 0; i < (kSize / kPatch) * (kSize / kPatch); ++i) {
    materials.push_back(RandomMaterial(&random));
  }
  for (size_t t = 0; t < truth.texels(); ++t) {
    const size_t patch = (t / kSize / kPatch) * (kSize / kPatch) + t % kSize / kPatch;
    TexelValues texel = materials[patch];
    texel[kSlopeX] = 0.4 * draw();
    texel[kSlopeY] = 0.4 * draw();
    for (int i = 0; i <= kRough; ++i) texel[i] *= 1.0 + 0.1 * draw();
    WriteTexel(texel, t, &truth);
    texel[kSlopeX] += 0.2 * draw();
    texel[kSlopeY] += 0.2 * draw();
    texel[kRough] += 0.15 * draw();
    for (int i = 0; i < kRough; ++i) texel[i] *= 1.0 + 0.4 * draw();
    WriteTexel(texel, t, &scene->start);
  }
  Photograph(truth, scene);
  for (int i = 0; i < kViews; ++i) {
    scene->problem.views.push_back(
        {scene->views[i], true, scene->photographs[i], scene->mask});
  }
}

class AllResiduals : public ceres::CostFunction {
 public:
  AllResiduals(const KernelOptions& options, const TexelObservations& observations,
               const TexelPrior& prior, KernelRows* rows)
      : options_(options),
        observations_(observations),
        prior_(prior),
        rows_(rows),
        scratch_(static_cast<size_t>(TexelResidualCount(observations)) * kTexelParameters) {
    mutable_parameter_block_sizes()->push_back(kTexelParameters);
    set_num_residuals(TexelResidualCount(observations));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    TexelValues texel;
    std::copy(parameters[0], parameters[0] + kTexelParameters, texel.begin());
    double* jacobian = jacobians != nullptr && jacobians[0] != nullptr ? jacobians[0]
                                                                       : scratch_.data();
    EvaluateTexelResiduals(options_, observations_, prior_, texel, rows_,
                           {residuals, static_cast<size_t>(num_residuals())},
                           {jacobian, scratch_.size()});
    return true;
  }

 private:
  const KernelOptions& options_;
  const TexelObservations& observations_;
  const TexelPrior& prior_;
  KernelRows* rows_;
  mutable std::vector<double> scratch_;
};

double SolveWithCeres(const KernelOptions& options, const TexelObservations& observations,
                      const TexelPrior& prior, ceres::LinearSolverType solver, TexelValues* texel,
                      KernelRows* rows) {
  ceres::Problem problem;
  problem.AddResidualBlock(new AllResiduals(options, observations, prior, rows), nullptr,
                           texel->data());
  for (int i = 0; i <= kRough; ++i) {
    problem.SetParameterLowerBound(texel->data(), i, i == kRough ? kRoughnessBounds.low : 0.0);
    problem.SetParameterUpperBound(texel->data(), i, 1.0);
  }
  ceres::Solver::Options ceres_options;
  ceres_options.linear_solver_type = solver;
  ceres_options.max_num_iterations = 50;
  ceres_options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(ceres_options, &problem, &summary);
  return summary.final_cost;
}

int Main() {
  Scene scene;
  MakeScene(&scene);
  const size_t texels = scene.start.texels();
  const RefineOptions options;

  double began = Now();
  const RefineResult refined = Refine(scene.problem, scene.start, options, 1);
  const double refine_rate = static_cast<double>(texels) / (Now() - began);
  fmt::print("refine:              {:9.0f} texels/s  mean cost {:.6f}\n", refine_rate,
             refined.summary.final_cost);

  const KernelOptions kernel{scene.problem.convention.diffuse_weight, options.robust_scale};
  const PriorWeights weights =
      HoldToStart(options.prior, refined.summary.residual_sigma, refined.summary.information, {});
  double best_rate = 0.0, cost = 0.0;
  for (const auto& [type, name] : {std::pair{ceres::DENSE_QR, "DENSE_QR"},
                                   std::pair{ceres::DENSE_NORMAL_CHOLESKY, "DENSE_NORMAL_CHOLESKY"}}) {
    TexelObservations observations(kViews);
    KernelRows rows(kViews);
    double total = 0.0;
    size_t solved = 0;
    began = Now();
    for (size_t t = 0; t < texels; ++t, ++solved) {
      GatherObservations(scene.problem, t, &observations);
      TexelValues texel = ReadTexel(scene.start, t);
      const TexelPrior prior(weights, texel);
      total += SolveWithCeres(kernel, observations, prior, type, &texel, &rows);
    }
    const double rate = static_cast<double>(solved) / (Now() - began);
    fmt::print("ceres::Solve, {:<21}: {:9.0f} texels/s  mean cost {:.6f}\n", name, rate,
               total / static_cast<double>(solved));
    if (rate > best_rate) {
      best_rate = rate;
      cost = total / static_cast<double>(solved);
    }
  }
  fmt::print("ratio {:.1f} (wanted: 15 or more), mean cost {:.6f} against {:.6f}\n",
             refine_rate / best_rate, refined.summary.final_cost, cost);
  return 0;
}

}  // namespace
}  // namespace glint

int main() { return glint::Main(); }
