#include "fitting/render/fused_loss.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "fitting/render/renderer.h"
#include "tests/fitting/render/random_scene.h"

namespace glint {
namespace {

struct Fit {
  ReflectanceConvention convention = ReflectanceConvention::Photograph();
  SvbrdfMaps maps;
  SamplePlane plane;
  std::vector<std::vector<float>> photographs, masks;
  std::vector<ViewImages> views;

  Fit(unsigned seed, int width, int height, int count) {
    RandomScene random(seed);
    maps = random.Maps(width, height);
    plane = TestPlane(width, height, convention);
    for (int v = 0; v < count; ++v) {
      photographs.push_back(random.Image(3 * maps.texels()));
      masks.push_back(random.Image(maps.texels()));
      for (size_t i = v; i < maps.texels(); i += 7) masks.back()[i] = 0;
    }
    for (int v = 0; v < count; ++v) {
      views.push_back({random.View(), photographs[v].data(), v % 2 ? masks[v].data() : nullptr});
    }
  }

  LossAndGradient Evaluate(const LogLossOptions& options) const {
    return EvaluateLogLoss(maps, plane, views, convention, options);
  }
};

TEST(FusedLossTest, LossIsEquation2OfTheRenderings) {
  for (const bool clamp : {false, true}) {
    const Fit fit(1, 33, 21, 4);
    LogLossOptions options;
    options.clamp_rendered = clamp;
    double total = 0, total_weight = 0;
    std::vector<double> view_losses;
    for (const ViewImages& view : fit.views) {
      std::vector<float> rendered(3 * fit.maps.texels());
      RenderView(fit.maps, fit.plane, view.view, fit.convention, rendered.data());
      double sum = 0, weight = 0;
      for (size_t i = 0; i < rendered.size(); ++i) {
        const double mask = view.mask ? view.mask[i % fit.maps.texels()] : 1;
        const double shown = clamp ? std::min(rendered[i], 1.0f) : rendered[i];
        sum += mask * std::abs(std::log(view.rgb_linear_planar[i] + 0.01) - std::log(shown + 0.01));
        weight += mask;
      }
      view_losses.push_back(sum / weight);
      total += sum;
      total_weight += weight;
    }
    const LossAndGradient result = fit.Evaluate(options);
    EXPECT_NEAR(result.loss, total / total_weight, 1e-6);
    for (size_t v = 0; v < fit.views.size(); ++v) {
      EXPECT_NEAR(result.view_losses[v], view_losses[v], 1e-6);
    }
    options.want_gradient = false;
    const LossAndGradient without = fit.Evaluate(options);
    EXPECT_NEAR(without.loss, result.loss, 1e-7);
    EXPECT_TRUE(without.gradient.planes.empty());
  }
}

TEST(FusedLossTest, StepAgainstTheGradientLowersTheLossAsPredicted) {
  Fit fit(2, 64, 48, 5);
  const LossAndGradient start = fit.Evaluate({});
  double squared = 0;
  for (const float slope : start.gradient.planes) squared += double{slope} * slope;
  const double step = 1e-3 * start.loss / squared;
  for (size_t i = 0; i < fit.maps.planes.size(); ++i) {
    fit.maps.planes[i] -= static_cast<float>(step * start.gradient.planes[i]);
  }
  const double drop = start.loss - fit.Evaluate({}).loss;
  EXPECT_NEAR(drop, 1e-3 * start.loss, 1e-4 * start.loss);
}

TEST(FusedLossTest, LightGradientPredictsAChangeOfPower) {
  Fit fit(3, 40, 30, 3);
  for (auto& photograph : fit.photographs) {
    std::fill(photograph.begin(), photograph.end(), 20.0f);  // brighter than any rendering
  }
  const LossAndGradient start = fit.Evaluate({});
  for (size_t v = 0; v < fit.views.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      Fit brighter = fit;
      for (size_t i = 0; i < fit.views.size(); ++i) {
        brighter.views[i].rgb_linear_planar = brighter.photographs[i].data();
      }
      const double step = 0.01 * fit.views[v].view.light_rgb[c];
      brighter.views[v].view.light_rgb[c] += step;
      const double high = brighter.Evaluate({}).loss;
      brighter.views[v].view.light_rgb[c] -= 2 * step;
      const double slope = (high - brighter.Evaluate({}).loss) / (2 * step);
      EXPECT_NEAR(start.light_gradients[v][c], slope, 2e-3 * std::abs(slope));
    }
  }
}

TEST(FusedLossTest, ThreadsDoNotChangeABit) {
  const Fit fit(4, 131, 150, 3);
  LogLossOptions options;
  const LossAndGradient one = fit.Evaluate(options);
  for (const int threads : {2, 3, 8, 0}) {
    options.threads = threads;
    const LossAndGradient more = fit.Evaluate(options);
    EXPECT_EQ(more.loss, one.loss);
    EXPECT_EQ(more.view_losses, one.view_losses);
    EXPECT_EQ(more.gradient.planes, one.gradient.planes);
    EXPECT_EQ(more.light_gradients, one.light_gradients);
    EXPECT_EQ(more.ambient_gradients, one.ambient_gradients);
  }
}

TEST(FusedLossTest, UnusableInputIsNamed) {
  Fit fit(5, 8, 8, 2);
  const auto message = [&](const LogLossOptions& options) -> std::string {
    try {
      fit.Evaluate(options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  LogLossOptions no_offset;
  no_offset.offset = 0;
  EXPECT_NE(message(no_offset).find("offset"), std::string::npos);
  const std::vector<float> closed(64, 0.0f);
  fit.views[0].mask = fit.views[1].mask = closed.data();
  EXPECT_NE(message({}).find("mask"), std::string::npos);
  fit.views[1].rgb_linear_planar = nullptr;
  EXPECT_NE(message({}).find("view 1"), std::string::npos);
}

}  // namespace
}  // namespace glint
