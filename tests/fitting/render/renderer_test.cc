#include "fitting/render/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/fitting/render/random_scene.h"

namespace glint {
namespace {

TEST(RendererTest, EveryWidthRendersTheReflectanceModel) {
  const ReflectanceConvention convention = ReflectanceConvention::Photograph();
  for (const int width : {1, 2, 7, 16, 17, 127, 128, 129, 300}) {
    RandomScene random(width);
    const SvbrdfMaps maps = random.Maps(width, 3, 0.3);
    const View view = random.View();
    const SamplePlane plane = TestPlane(width, 3, convention);
    std::vector<float> rendered(3 * maps.texels() + 1, -5.0f);
    RenderView(maps, plane, view, convention, rendered.data());
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < width; ++column) {
        const size_t i = static_cast<size_t>(row) * width + column;
        const auto geometry =
            TexelGeometryInView(view, convention.falloff, plane.x_mm(column), plane.y_mm(row));
        double radiance[3];
        ShadeRadiance(TexelAt(maps, i), geometry, convention, radiance);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(rendered[c * maps.texels() + i], radiance[c], 2e-5 * radiance[c]);
        }
      }
    }
    EXPECT_EQ(rendered.back(), -5.0f) << "wrote past the image's end";
  }
}

TEST(RendererTest, MapsInOthersMemoryGiveTheSameBits) {
  const ReflectanceConvention convention = ReflectanceConvention::Photograph();
  RandomScene random(8);
  const SvbrdfMaps maps = random.Maps(19, 7);
  const SamplePlane plane = TestPlane(19, 7, convention);
  const View view = random.View();
  const size_t values = 3 * maps.texels();
  std::vector<float> expected(values), rendered(values), gradient(maps.planes.size());
  RenderView(maps, plane, view, convention, expected.data());
  RenderView(maps.planes, plane, view, convention, rendered.data());
  EXPECT_EQ(rendered, expected);
  const std::vector<float> image = random.Image(values);
  const std::vector<ViewImage> images = {{view, image.data()}};
  AdjointOfViews(maps.planes, plane, images, convention, gradient);
  EXPECT_EQ(gradient, AdjointOfViews(maps, plane, images, convention).planes);
  const std::span<const float> short_of_one(maps.planes.data(), maps.planes.size() - 1);
  EXPECT_THROW(RenderView(short_of_one, plane, view, convention, rendered.data()),
               std::invalid_argument);
}

TEST(RendererTest, AdjointAgreesWithRenderingInTheDotProduct) {
  // ⟨J·δ, g⟩ = ⟨δ, Jᵀ·g⟩, with J·δ by differences of two renderings.
  const ReflectanceConvention convention = ReflectanceConvention::MaterialGan();
  RandomScene random(5);
  const SvbrdfMaps maps = random.Maps(40, 30, 0.4);
  const SamplePlane plane = TestPlane(40, 30, convention);
  const View views[2] = {random.View(), random.View()};
  const size_t values = 3 * maps.texels();
  const std::vector<float> gradients[2] = {random.Image(values), random.Image(values)};
  const std::vector<ViewImage> images = {{views[0], gradients[0].data()},
                                         {views[1], gradients[1].data()}};
  const SvbrdfMaps adjoint = AdjointOfViews(maps, plane, images, convention);
  SvbrdfMaps plus = maps, minus = maps;
  double expected = 0;
  for (size_t i = 0; i < maps.planes.size(); ++i) {
    const double delta = random.Uniform(-2e-3, 2e-3);
    plus.planes[i] += static_cast<float>(delta);
    minus.planes[i] -= static_cast<float>(delta);
    expected += (plus.planes[i] - minus.planes[i]) * adjoint.planes[i];
  }
  double difference = 0;
  for (int v = 0; v < 2; ++v) {
    std::vector<float> high(values), low(values);
    RenderView(plus, plane, views[v], convention, high.data());
    RenderView(minus, plane, views[v], convention, low.data());
    for (size_t i = 0; i < values; ++i) difference += (high[i] - low[i]) * gradients[v][i];
  }
  EXPECT_NEAR(difference, expected, 1e-3 * std::abs(expected));
}

TEST(RendererTest, ThreadsDoNotChangeABit) {
  const ReflectanceConvention convention = ReflectanceConvention::Photograph();
  RandomScene random(6);
  const SvbrdfMaps maps = random.Maps(131, 150);
  const SamplePlane plane = TestPlane(131, 150, convention);
  const View view = random.View();
  std::vector<float> one(3 * maps.texels()), more(3 * maps.texels());
  RenderView(maps, plane, view, convention, one.data(), 1);
  const ViewImage image{view, one.data()};
  const SvbrdfMaps adjoint = AdjointOfViews(maps, plane, {&image, 1}, convention, 1);
  for (const int threads : {2, 3, 8, 0}) {
    RenderView(maps, plane, view, convention, more.data(), threads);
    EXPECT_EQ(one, more);
    EXPECT_EQ(AdjointOfViews(maps, plane, {&image, 1}, convention, threads).planes, adjoint.planes);
  }
}

TEST(RendererTest, SizesThatDisagreeAreNamed) {
  const SvbrdfMaps maps(4, 3);
  std::vector<float> image(36);
  const SamplePlane plane{3, 4, 1, 1};
  try {
    RenderView(maps, plane, View(), ReflectanceConvention(), image.data());
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("4x3"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("3x4"), std::string::npos) << error.what();
  }
  SvbrdfMaps torn(4, 3);
  torn.planes.resize(7);
  EXPECT_THROW(RenderView(torn, {4, 3, 1, 1}, View(), ReflectanceConvention(), image.data()),
               std::invalid_argument);
}

}  // namespace
}  // namespace glint
