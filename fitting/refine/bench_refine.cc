// Refinement against one bounded ceres::Solve per texel: the same texels, starts and residuals (20
// views of 8 bit, robust, with the prior), one thread, one process. Prints texels per second, the
// ratio and both mean costs. Refinement's time is all that it spends on texels: several starts,
// neighbours, confidence. What it estimates of the sample before (docs/model.md), which does not
// grow with the maps and gives Ceres the scale of its prior too, is printed apart. Ceres has the
// residuals as one writes them: autodiff of brdf.h, a block per view.
#include <ceres/ceres.h>
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "base/cpu/instruction_set.h"
#include "base/model/photographs.h"
#include "base/reflectance/log_radiance.h"
#include "base/reflectance/texel_at.h"
#include "fitting/refine/estimate_sample.h"
#include "fitting/refine/refine.h"
#include "fitting/refine/refine_rows.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

constexpr int kSize = 128;
constexpr int kViews = 20;
constexpr int kRounds = 3;

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
      double radiance[3];
      ShadeRadiance(TexelAt(truth, t),
                    TexelGeometryInView<double>(view, LightFalloff::kNone,
                                                scene->problem.plane.x_mm(int(t % kSize)),
                                                scene->problem.plane.y_mm(int(t / kSize))),
                    {DiffuseWeight::kOne}, radiance);
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
  std::vector<TexelValues> materials((kSize / kPatch) * (kSize / kPatch));
  for (TexelValues& material : materials) material = RandomMaterial(&random);
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
    scene->problem.views.push_back({scene->views[i], true, scene->photographs[i], scene->mask});
  }
}

// The residuals as one writes them for Ceres: reflectance/brdf.h, differentiated by Ceres.
struct ViewResiduals {
  TexelGeometry<double> geometry;
  double log_target[3];
  bool clipped[3];
  KernelOptions options;

  template <class T>
  bool operator()(const T* x, T* residuals) const {
    using std::log;
    using std::sqrt;
    const TexelSvbrdf<T> texel = TexelFromValues(x);
    const TexelGeometry<T> view = GeometryAs<T>(geometry);
    T radiance[3];
    ShadeRadiance(texel, view, {options.diffuse_weight}, radiance);
    for (int c = 0; c < 3; ++c) {
      T error = log(radiance[c] + kLogOffset) - log_target[c];
      if (clipped[c] && error > T(0)) error = T(0);
      const T scaled = error / options.robust_scale;
      residuals[c] = error * sqrt(T(2) / (T(1) + sqrt(T(1) + scaled * scaled)));
    }
    return true;
  }
};

// What holds the texel to its start, with derivatives by hand.
class PriorResiduals : public ceres::SizedCostFunction<kTexelParameters, kTexelParameters> {
 public:
  explicit PriorResiduals(const TexelPrior& prior) : prior_(prior) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    TexelValues texel;
    std::copy(parameters[0], parameters[0] + kTexelParameters, texel.begin());
    double jacobian[kTexelParameters][kTexelParameters];
    prior_.Evaluate(texel, residuals, jacobian);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      std::copy(&jacobian[0][0], &jacobian[0][0] + kTexelParameters * kTexelParameters,
                jacobians[0]);
    }
    return true;
  }

 private:
  const TexelPrior& prior_;
};

double SolveBounded(ceres::Problem* problem, TexelValues* texel) {
  for (int i = 0; i <= kRough; ++i) {
    problem->SetParameterLowerBound(texel->data(), i, i == kRough ? kRoughnessBounds.low : 0.0);
    problem->SetParameterUpperBound(texel->data(), i, 1.0);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 50;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem, &summary);
  return summary.final_cost;
}

struct Side {
  double rate = 0;  // texels per second
  double cost = 0;  // mean
};

void AddViewBlocks(const Scene& scene, size_t t, const KernelOptions& options,
                   ceres::Problem* problem, TexelValues* texel) {
  for (const RefineView& view : scene.problem.views) {
    auto* residuals = new ViewResiduals;
    residuals->geometry = TexelGeometryInView<double>(view.view, scene.problem.convention.falloff,
                                                      scene.problem.plane.x_mm(int(t % kSize)),
                                                      scene.problem.plane.y_mm(int(t / kSize)));
    for (int c = 0; c < 3; ++c) {
      const double radiance = view.rgb[c * scene.start.texels() + t];
      residuals->log_target[c] = std::log(radiance + kLogOffset);
      residuals->clipped[c] = radiance >= constants::kClippedRadiance;
    }
    residuals->options = options;
    problem->AddResidualBlock(
        new ceres::AutoDiffCostFunction<ViewResiduals, 3, kTexelParameters>(residuals), nullptr,
        texel->data());
  }
}

Side SolveWithCeres(const Scene& scene, const KernelOptions& options, double scale) {
  const size_t texels = scene.start.texels();
  double total = 0.0;
  const double began = Now();
  for (size_t t = 0; t < texels; ++t) {
    TexelValues texel = ReadTexel(scene.start, t);
    const TexelPrior prior(TexelGaussian(texel, InitialisationErrors()), scale);
    ceres::Problem problem;
    AddViewBlocks(scene, t, options, &problem, &texel);
    problem.AddResidualBlock(new PriorResiduals(prior), nullptr, texel.data());
    total += SolveBounded(&problem, &texel);
  }
  const double n = static_cast<double>(texels);
  return {n / (Now() - began), total / n};
}

void Print(const char* name, const Side& side) {
  fmt::print("{:<40} {:7.0f} texels/s, mean cost {:.6f}\n", name, side.rate, side.cost);
}

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

int Main() {
  Scene scene;
  MakeScene(&scene);
  RefineOptions options;
  const KernelOptions kernel{scene.problem.convention.diffuse_weight, {}, options.robust_scale};
  fmt::print("{}² texels, {} views, one thread, {}\n", kSize, kViews, Name(BestInstructionSet()));
  // Both in turn, several times: what disturbs one round disturbs both alike.
  std::vector<double> ratios;
  for (int round = 0; round < kRounds; ++round) {
    double began = Now();
    const SampleEstimate estimate = EstimateSample(scene.problem, scene.start, options, 1);
    fmt::print("the sample's estimate, whatever the maps' size: {:.2f} s\n", Now() - began);
    began = Now();
    RowRefiner refiner(estimate, options, scene.problem, {0, kSize}, {}, 1, {});
    refiner.Take(scene.problem, scene.start, 0, 0);
    for (int step = 0; step < refiner.steps(); ++step) refiner.Do(step);
    const double seconds = Now() - began;
    const RefineSummary summary = Summarise(estimate, refiner.sums(), kSize);
    const Side refine{static_cast<double>(scene.start.texels()) / seconds, summary.final_cost};
    Print("refinement of texels, all of it", refine);

    const Side ceres = SolveWithCeres(scene, kernel, summary.residual_sigma);
    Print("bounded ceres::Solve per texel", ceres);
    ratios.push_back(refine.rate / ceres.rate);
    if (round + 1 == kRounds) {
      fmt::print(
          "ratio {:.1f} (target: 30 or more with AVX-512, 18 with AVX2), mean cost {:.6f} against "
          "{:.6f}\n",
          Median(ratios), refine.cost, ceres.cost);
    }
  }
  return 0;
}

}  // namespace
}  // namespace glint

int main() { return glint::Main(); }
