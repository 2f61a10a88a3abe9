// The fused kernel in double precision, where differences can be told from errors, and in float.
#include "fitting/render/kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "fitting/render/batch.h"
#include "tests/base/reflectance/texel_jacobian.h"
#include "tests/fitting/render/random_scene.h"

namespace glint {
namespace {

using kernel::Mode;

std::vector<InstructionSet> AvailableSets() {
  std::vector<InstructionSet> sets;
  for (const auto set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (Available(set)) sets.push_back(set);
  }
  return sets;
}

// Everything one run of the kernel reads and writes, in T.
template <class T>
struct Scene {
  std::vector<T> planes, target_planes, gradient;
  std::vector<std::vector<T>> images, masks, rendered;
  std::vector<View> views;
  SamplePlane plane;
  ReflectanceConvention convention;
  bool clamp = false;

  std::vector<kernel::ViewSums> Run(Mode mode, InstructionSet set) {
    const kernel::Grid<T> grid(plane);
    std::vector<kernel::View<T>> kernel_views;
    const size_t texels = static_cast<size_t>(plane.width) * plane.height;
    rendered.assign(views.size(), std::vector<T>(3 * texels));
    gradient.assign(planes.size(), T(-77));
    for (size_t v = 0; v < views.size(); ++v) {
      kernel_views.push_back(kernel::MakeView<T>(views[v]));
      kernel_views[v].image = images.empty() ? nullptr : images[v].data();
      kernel_views[v].mask = masks.empty() ? nullptr : masks[v].data();
      kernel_views[v].rendered = rendered[v].data();
    }
    kernel::Job<T> job = kernel::MakeJob<T>(grid, convention, kernel_views);
    job.planes = planes.data();
    job.target_planes = target_planes.empty() ? nullptr : target_planes.data();
    job.gradient = gradient.data();
    job.clamp_rendered = clamp;
    return kernel::RunJobs<T>({&job, 1}, mode, kernel::ThreadRunner(1), set);
  }

  double Loss(InstructionSet set) {
    double loss = 0;
    for (const kernel::ViewSums& sums : Run(Mode::kLoss, set)) loss += sums.loss();
    return loss;
  }
};

template <class T, class Range>
std::vector<T> As(const Range& values) {
  return {values.begin(), values.end()};
}

template <class T>
Scene<T> MakeScene(unsigned seed, int width, int height, int views,
                   const ReflectanceConvention& convention) {
  RandomScene random(seed);
  Scene<T> scene;
  scene.convention = convention;
  scene.plane = TestPlane(width, height, convention);
  scene.planes = As<T>(random.Maps(width, height).planes);
  const size_t texels = static_cast<size_t>(width) * height;
  for (int v = 0; v < views; ++v) {
    scene.views.push_back(random.View());
    if (convention.falloff == LightFalloff::kNone) scene.views.back().light_rgb = {3, 2, 4};
    scene.images.push_back(As<T>(random.Image(3 * texels)));
    scene.masks.push_back(As<T>(random.Image(texels, 2)));
  }
  return scene;
}

TexelSvbrdf<double> TexelOf(const std::vector<double>& planes, size_t texels, size_t i) {
  TexelSvbrdf<double> texel;
  for (int a = 0; a < 3; ++a) {
    texel.normal[a] = planes[(kNormalX + a) * texels + i];
    texel.diffuse[a] = planes[(kDiffuseR + a) * texels + i];
    texel.specular[a] = planes[(kSpecularR + a) * texels + i];
  }
  texel.roughness = planes[kRoughness * texels + i];
  return texel;
}

// Calls check(view, texel index, radiance[3], jacobian[3×10]) with ShadeTexel's results.
using CheckTexel = std::function<void(size_t, size_t, const double*, const double*)>;
void ForEachTexel(const Scene<double>& scene, const CheckTexel& check) {
  const SamplePlane& plane = scene.plane;
  const size_t texels = static_cast<size_t>(plane.width) * plane.height;
  for (size_t v = 0; v < scene.views.size(); ++v) {
    for (int row = 0; row < plane.height; ++row) {
      for (int column = 0; column < plane.width; ++column) {
        const size_t i = static_cast<size_t>(row) * plane.width + column;
        const auto geometry = TexelGeometryInView(scene.views[v], scene.convention.falloff,
                                                  plane.x_mm(column), plane.y_mm(row));
        double radiance[3], jacobian[3 * kSvbrdfPlanes];
        ShadeTexel(TexelOf(scene.planes, texels, i), geometry, scene.convention, radiance,
                   jacobian);
        check(v, i, radiance, jacobian);
      }
    }
  }
}

class KernelTest : public testing::TestWithParam<InstructionSet> {};

INSTANTIATE_TEST_SUITE_P(Sets, KernelTest, testing::ValuesIn(AvailableSets()),
                         [](const auto& param_info) { return Name(param_info.param); });

TEST_P(KernelTest, RendersTheReflectanceModel) {
  for (const ReflectanceConvention& convention : AllConventions()) {
    Scene<double> scene = MakeScene<double>(1, 37, 9, 3, convention);
    scene.Run(Mode::kRender, GetParam());
    const size_t texels = 37 * 9;
    ForEachTexel(scene, [&](size_t v, size_t i, const double* radiance, const double*) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(scene.rendered[v][c * texels + i], radiance[c], 1e-11 * radiance[c]);
      }
    });
  }
}

void ExpectAdjointIsTransposedJacobian(Scene<double>* scene, InstructionSet set, double tolerance) {
  scene->Run(Mode::kAdjoint, set);
  const size_t texels = static_cast<size_t>(scene->plane.width) * scene->plane.height;
  std::vector<double> expected(scene->planes.size()), scale(scene->planes.size());
  ForEachTexel(*scene, [&](size_t v, size_t i, const double*, const double* jacobian) {
    for (int p = 0; p < kSvbrdfPlanes; ++p) {
      for (int c = 0; c < 3; ++c) {
        const double term = scene->images[v][c * texels + i] * jacobian[c * kSvbrdfPlanes + p];
        expected[p * texels + i] += term;
        scale[p * texels + i] += std::abs(term);
      }
    }
  });
  for (size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(scene->gradient[i], expected[i], tolerance * scale[i] + 1e-13)
        << "plane " << i / texels;
  }
}

TEST_P(KernelTest, AdjointIsTheTransposedJacobian) {
  for (const ReflectanceConvention& convention : AllConventions()) {
    Scene<double> scene = MakeScene<double>(2, 37, 9, 3, convention);
    ExpectAdjointIsTransposedJacobian(&scene, GetParam(), 1e-9);
  }
}

TEST_P(KernelTest, AdjointIsTheTransposedJacobianBeyondClamps) {
  for (const ReflectanceConvention& convention : AllConventions()) {
    Scene<double> scene = MakeScene<double>(12, 37, 9, 3, convention);
    const size_t texels = 37 * 9;
    for (size_t i = 0; i < texels; ++i) {
      if (i % 2) std::swap(scene.planes[i], scene.planes[2 * texels + i]);  // nearly edge-on
      if (i % 3 == 0) scene.planes[2 * texels + i] *= -1;                   // turned away
      if (i % 5 == 0) scene.planes[kRoughness * texels + i] = 5e-5;
    }
    // Mirrors in (but not exactly in) their own reflection: D's denominator is below its clamp.
    for (int column = 0; column < 30; ++column) {
      const auto geometry = TexelGeometryInView(scene.views[0], convention.falloff,
                                                scene.plane.x_mm(column), scene.plane.y_mm(0));
      const double offset = 5e-5 / std::sqrt(1 - geometry.half[0] * geometry.half[0]);
      for (int a = 0; a < 3; ++a) {
        scene.planes[a * texels + column] = geometry.half[a] * (1 - offset * geometry.half[0]);
      }
      scene.planes[column] += offset;
      scene.planes[kRoughness * texels + column] = 5e-4 * (column + 1);
    }
    ExpectAdjointIsTransposedJacobian(&scene, GetParam(), 1e-7);
  }
}

// A central difference of 4th order, of a function that is smooth over `step`s.
double Difference(const std::function<double(double)>& loss_at, double step) {
  return (8 * (loss_at(step) - loss_at(-step)) - (loss_at(2 * step) - loss_at(-2 * step))) /
         (12 * step);
}

TEST_P(KernelTest, LossGradientMatchesDifferencesAt1000RandomPoints) {
  constexpr double kStep = 1e-5;
  const size_t texels = 25;
  int points = 0;
  for (unsigned seed = 0; points < 1000; ++seed) {
    const auto& convention = AllConventions()[seed % AllConventions().size()];
    Scene<double> scene = MakeScene<double>(100 + seed, 5, 5, 2, convention);
    scene.clamp = seed % 2 == 1;
    // Photographs apart from the renderings, as the loss has a corner where they are equal.
    scene.Run(Mode::kRender, GetParam());
    for (size_t v = 0; v < scene.views.size(); ++v) {
      for (size_t i = 0; i < scene.images[v].size(); ++i) {
        const double shown = scene.rendered[v][i];
        if (scene.clamp && std::abs(shown - 1) < 0.01) scene.masks[v][i % texels] = 0;
        if (std::abs(scene.images[v][i] - std::min(shown, 1.0)) < 0.01) {
          scene.images[v][i] = 0.5 * shown;
        }
      }
    }
    scene.Run(Mode::kLossGradient, GetParam());
    const std::vector<double> gradient = scene.gradient;
    for (int k = 0; k < 50; ++k, ++points) {
      const size_t i = (k * 37 + seed * 11) % scene.planes.size();
      const double kept = scene.planes[i];
      const double expected = Difference(
          [&](double step) {
            scene.planes[i] = kept + step;
            return scene.Loss(GetParam());
          },
          kStep);
      scene.planes[i] = kept;
      // The texel's own terms set the scale: the rounding of the whole sum does, too.
      EXPECT_NEAR(gradient[i], expected, 1e-6 * std::abs(expected) + 3e-9)
          << "plane " << i / texels << " seed " << seed;
    }
  }
}

TEST_P(KernelTest, LightAndAmbientGradientsMatchDifferences) {
  for (const ReflectanceConvention& convention : AllConventions()) {
    Scene<double> scene = MakeScene<double>(3, 21, 6, 2, convention);
    scene.images[0].assign(scene.images[0].size(), 30.0);  // brighter and darker than rendered
    scene.images[1].assign(scene.images[1].size(), 0.0);
    const auto sums = scene.Run(Mode::kLossGradient, GetParam());
    for (size_t v = 0; v < scene.views.size(); ++v) {
      const double exposure = scene.views[v].exposure;
      for (int c = 0; c < 3; ++c) {
        const auto differentiate = [&](double* value) {
          const double kept = *value;
          const double slope = Difference(
              [&](double step) {
                *value = kept + step;
                return scene.Loss(GetParam());
              },
              1e-3 * kept + 1e-4);
          *value = kept;
          return slope;
        };
        const double by_light = differentiate(&scene.views[v].light_rgb[c]);
        const double by_ambient = differentiate(&scene.views[v].ambient_rgb[c]);
        EXPECT_NEAR(sums[v].light(c) * exposure, by_light, 1e-6 * std::abs(by_light));
        EXPECT_NEAR(sums[v].ambient(c) * exposure, by_ambient, 1e-6 * std::abs(by_ambient));
      }
    }
  }
}

TEST_P(KernelTest, LossBetweenMapsIsTheLossAgainstTheirRenderings) {
  for (const bool clamp : {false, true}) {
    Scene<double> scene = MakeScene<double>(4, 21, 6, 3, ReflectanceConvention::Photograph());
    scene.clamp = clamp;
    Scene<double> target = MakeScene<double>(5, 21, 6, 0, ReflectanceConvention::Photograph());
    target.views = scene.views;
    target.Run(Mode::kRender, GetParam());
    scene.images = target.rendered;
    if (clamp) {
      for (auto& image : scene.images) {
        for (double& value : image) value = std::min(value, 1.0);
      }
    }
    const double expected = scene.Loss(GetParam());
    scene.Run(Mode::kLossGradient, GetParam());
    const std::vector<double> expected_gradient = scene.gradient;
    scene.images.clear();
    scene.target_planes = target.planes;
    EXPECT_NEAR(scene.Loss(GetParam()), expected, 1e-12 * expected);
    scene.Run(Mode::kLossGradient, GetParam());
    EXPECT_EQ(scene.gradient, expected_gradient);
  }
}

TEST_P(KernelTest, SinglePrecisionAgreesWithDouble) {
  const ReflectanceConvention convention = ReflectanceConvention::Photograph();
  Scene<double> exact = MakeScene<double>(6, 61, 33, 4, convention);
  Scene<float> rounded = MakeScene<float>(6, 61, 33, 4, convention);
  const auto exact_sums = exact.Run(Mode::kLossGradient, GetParam());
  const auto rounded_sums = rounded.Run(Mode::kLossGradient, GetParam());
  for (size_t v = 0; v < exact_sums.size(); ++v) {
    EXPECT_NEAR(rounded_sums[v].loss(), exact_sums[v].loss(), 1e-6 * exact_sums[v].loss());
    EXPECT_NEAR(rounded_sums[v].weight(), exact_sums[v].weight(), 1e-6 * exact_sums[v].weight());
  }
  const size_t texels = 61 * 33;
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    double error = 0, norm = 0;
    for (size_t i = p * texels; i < (p + 1) * texels; ++i) {
      error += std::pow(rounded.gradient[i] - exact.gradient[i], 2);
      norm += std::pow(exact.gradient[i], 2);
    }
    EXPECT_LT(std::sqrt(error / norm), 1e-5) << "plane " << p;
  }
}

// |log ratio| of one texel against the library's logarithm: 1 to 1e6 below and above.
TEST_P(KernelTest, SinglePrecisionLogarithmIsAccurate) {
  Scene<float> scene = MakeScene<float>(7, 1, 1, 1, ReflectanceConvention::Photograph());
  scene.masks.clear();
  scene.Run(Mode::kRender, GetParam());
  const std::vector<float> rendered = scene.rendered[0];
  RandomScene random(8);
  for (int k = 0; k < 1000; ++k) {
    double expected = 0;
    for (int c = 0; c < 3; ++c) {
      scene.images[0][c] = static_cast<float>(std::pow(10.0, random.Uniform(-3, 4)));
      expected += std::abs(std::log((scene.images[0][c] + 0.01) / (rendered[c] + 0.01)));
    }
    EXPECT_NEAR(scene.Loss(GetParam()), expected, 2e-7 * expected + 6e-7);
  }
}

TEST_P(KernelTest, MaskedTexelsMayHoldAnything) {
  Scene<float> scene = MakeScene<float>(9, 19, 4, 2, ReflectanceConvention::Photograph());
  const size_t texels = scene.masks[0].size();
  for (size_t i = 0; i < texels; i += 3) scene.masks[0][i] = 0;
  scene.Run(Mode::kLossGradient, GetParam());
  const std::vector<float> expected = scene.gradient;
  const double loss = scene.Loss(GetParam());
  for (size_t i = 0; i < texels; i += 3) {
    scene.images[0][i] = std::numeric_limits<float>::quiet_NaN();
    scene.images[0][i + texels] = std::numeric_limits<float>::infinity();
    scene.images[0][i + 2 * texels] = -3;
  }
  EXPECT_EQ(scene.Loss(GetParam()), loss);
  scene.Run(Mode::kLossGradient, GetParam());
  EXPECT_EQ(scene.gradient, expected);
}

TEST_P(KernelTest, TexelsThatAreNotNumbersCountAsMasked) {
  Scene<float> masked = MakeScene<float>(13, 19, 4, 2, ReflectanceConvention::Photograph());
  Scene<float> broken = masked;
  const size_t texels = masked.masks[0].size();
  for (size_t i = 0; i < texels; i += 3) {
    masked.masks[1][i] = 0;
    broken.images[1][i + i % 2 * texels] = std::numeric_limits<float>::quiet_NaN();
  }
  const auto expected = masked.Run(Mode::kLossGradient, GetParam());
  const auto found = broken.Run(Mode::kLossGradient, GetParam());
  for (int i = 0; i < kernel::ViewSums::kCount; ++i) {
    EXPECT_EQ(found[1].values[i], expected[1].values[i]);
  }
  EXPECT_EQ(broken.gradient, masked.gradient);
}

TEST_P(KernelTest, ExactMatchHasNoLossAndNoGradient) {
  Scene<float> scene = MakeScene<float>(10, 40, 5, 2, ReflectanceConvention::Photograph());
  scene.target_planes = scene.planes;
  EXPECT_EQ(scene.Loss(GetParam()), 0);
  scene.Run(Mode::kLossGradient, GetParam());
  EXPECT_TRUE(std::all_of(scene.gradient.begin(), scene.gradient.end(),
                          [](float value) { return value == 0; }));
}

TEST_P(KernelTest, ExtremeTexelsStayFinite) {
  Scene<float> scene = MakeScene<float>(11, 64, 8, 2, ReflectanceConvention::Photograph());
  const size_t texels = 64 * 8;
  for (size_t i = 0; i < texels; ++i) {
    scene.planes[kRoughness * texels + i] = i % 3 == 0 ? 0.0f : (i % 3 == 1 ? 1e-4f : 1.0f);
    if (i % 5 == 0) scene.planes[kNormalZ * texels + i] *= -1;  // faces away
    if (i % 7 == 0) {                                           // a mirror straight up
      scene.planes[kNormalX * texels + i] = scene.planes[kNormalY * texels + i] = 0;
      scene.planes[kNormalZ * texels + i] = 1;
    }
  }
  scene.views[0].camera_in_sample_mm = scene.views[0].light_in_sample_mm = {0, 0, 300};
  const auto sums = scene.Run(Mode::kLossGradient, GetParam());
  for (const auto& view : sums) {
    for (const double value : view.values) EXPECT_TRUE(std::isfinite(value));
  }
  for (const float value : scene.gradient) ASSERT_TRUE(std::isfinite(value));
  scene.Run(Mode::kRender, GetParam());
  for (const auto& image : scene.rendered) {
    for (const float value : image) ASSERT_TRUE(std::isfinite(value) && value >= 0);
  }
}

}  // namespace
}  // namespace glint
