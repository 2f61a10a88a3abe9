// The fused kernel in autograd against the same renderer in plain torch operations.
#include "fitting/render/render_autograd.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

#include <vector>

#include "fitting/render/render_reference.h"
#include "tests/fitting/render/random_scene.h"

namespace glint {
namespace {

using torch::Tensor;

struct Scene {
  ViewBatch batch;
  Tensor maps, images, masks, light_rgb;
};

Tensor FromPlanes(const SvbrdfMaps& maps) {
  return torch::tensor(maps.planes).view({kSvbrdfPlanes, maps.height, maps.width});
}

Scene MakeScene(unsigned seed, const ReflectanceConvention& convention, int elements = 2,
                int views = 3, int width = 45, int height = 19) {
  torch::set_num_threads(1);
  torch::manual_seed(seed);
  RandomScene random(seed);
  Scene scene;
  scene.batch.convention = convention;
  scene.batch.plane = TestPlane(width, height, convention);
  scene.batch.views_per_element = views;
  std::vector<Tensor> maps;
  for (int b = 0; b < elements; ++b) maps.push_back(FromPlanes(random.Maps(width, height, 0.25)));
  scene.maps = torch::stack(maps);
  for (int v = 0; v < elements * views; ++v) {
    scene.batch.views.push_back(random.View());
    if (convention.falloff == LightFalloff::kNone) scene.batch.views.back().light_rgb = {3, 2, 4};
  }
  scene.images = torch::rand({elements, views, 3, height, width});
  scene.masks = torch::rand({elements, views, height, width});
  scene.masks = torch::where(scene.masks > 0.8, torch::zeros_like(scene.masks), scene.masks);
  const double power = convention.falloff == LightFalloff::kNone ? 3 : 1e5;
  scene.light_rgb = power * (0.5 + torch::rand({elements, views, 3}));
  return scene;
}

Tensor Variable(const Tensor& tensor, torch::Dtype type = torch::kFloat32) {
  return tensor.to(type).detach().clone().requires_grad_();
}

// Largest difference relative to the largest value of each plane of the maps.
void ExpectGradientsNear(const Tensor& found, const Tensor& expected, double tolerance) {
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    const Tensor f = found.select(1, p).to(torch::kFloat64), e = expected.select(1, p);
    EXPECT_LT((f - e).norm().item<double>(), tolerance * e.norm().item<double>()) << "plane " << p;
  }
}

// Gradients by maps [B, 10, H, W] with what they have along the normals taken out.
Tensor AcrossNormals(const Tensor& gradient, const Tensor& maps) {
  const Tensor normal = maps.detach().slice(1, kNormalX, kDiffuseR);
  const Tensor by_normal = gradient.slice(1, kNormalX, kDiffuseR);
  const Tensor along = (by_normal * normal).sum(1, true) / (normal * normal).sum(1, true);
  return torch::cat({by_normal - along * normal, gradient.slice(1, kDiffuseR)}, 1);
}

TEST(RenderAutogradTest, RenderingsAndGradientsMatchTheReference) {
  for (const ReflectanceConvention& convention : AllConventions()) {
    const Scene scene = MakeScene(1, convention);
    const Tensor fused_maps = Variable(scene.maps);
    const Tensor fused = RenderBatch(fused_maps, scene.batch);
    const Tensor maps = Variable(scene.maps, torch::kFloat64);
    const Tensor reference = RenderReference(maps, {}, scene.batch);
    EXPECT_TRUE(torch::allclose(fused.to(torch::kFloat64), reference, 3e-5, 1e-6));
    (fused * scene.images).sum().backward();
    (reference * scene.images).sum().backward();
    // Along the normal itself large terms cancel, and nothing moves (see brdf.h).
    ExpectGradientsNear(AcrossNormals(fused_maps.grad().to(torch::kFloat64), maps),
                        AcrossNormals(maps.grad(), maps), 1e-5);
  }
}

TEST(RenderAutogradTest, LossAndItsGradientsMatchTheReference) {
  for (const ReflectanceConvention& convention : AllConventions()) {
    for (const bool clamp : {false, true}) {
      const Scene scene = MakeScene(2, convention);
      const TensorLossOptions options{clamp, 0.02};
      const Tensor fused_maps = Variable(scene.maps), fused_light = Variable(scene.light_rgb);
      const Tensor fused =
          LogLossBatch(fused_maps, scene.images, scene.masks, fused_light, scene.batch, options);
      const Tensor maps = Variable(scene.maps, torch::kFloat64);
      const Tensor light = Variable(scene.light_rgb, torch::kFloat64);
      const Tensor reference = LogLossReference(RenderReference(maps, light, scene.batch),
                                                scene.images.to(torch::kFloat64),
                                                scene.masks.to(torch::kFloat64), options);
      EXPECT_NEAR(fused.item<double>(), reference.item<double>(), 1e-6);
      (3 * fused).backward();
      (3 * reference).backward();
      ExpectGradientsNear(fused_maps.grad(), maps.grad(), 1e-4);
      EXPECT_TRUE(torch::allclose(fused_light.grad().to(torch::kFloat64), light.grad(), 1e-4,
                                  1e-6 * light.grad().abs().max().item<double>()));
    }
  }
}

TEST(RenderAutogradTest, AbsentMasksAndLightMeanOnesAndTheViewsOwn) {
  const Scene scene = MakeScene(3, ReflectanceConvention::Photograph());
  std::vector<float> own;
  for (const View& view : scene.batch.views) {
    for (const double value : view.light_rgb) own.push_back(static_cast<float>(value));
  }
  const Tensor light = torch::tensor(own).view_as(scene.light_rgb);
  const Tensor absent = LogLossBatch(scene.maps, scene.images, {}, {}, scene.batch, {});
  const Tensor given =
      LogLossBatch(scene.maps, scene.images, torch::ones_like(scene.masks), light, scene.batch, {});
  EXPECT_NEAR(absent.item<double>(), given.item<double>(), 1e-6);
  const Tensor reference =
      LogLossReference(RenderReference(scene.maps, {}, scene.batch), scene.images, {}, {});
  EXPECT_NEAR(absent.item<double>(), reference.item<double>(), 1e-5);
}

TEST(RenderAutogradTest, LightAloneCanBeTheVariable) {
  const Scene scene = MakeScene(4, ReflectanceConvention::Photograph());
  const Tensor light = Variable(scene.light_rgb);
  LogLossBatch(scene.maps, scene.images, scene.masks, light, scene.batch, {}).backward();
  EXPECT_GT(light.grad().abs().min().item<double>(), 0);
  EXPECT_FALSE(scene.maps.grad().defined());
}

TEST(RenderAutogradTest, LossBetweenMapsMatchesLossOfTheirRenderings) {
  const Scene scene = MakeScene(5, ReflectanceConvention::Photograph());
  const Scene target = MakeScene(6, ReflectanceConvention::Photograph());
  const Tensor maps = Variable(scene.maps), same_maps = Variable(scene.maps);
  const Tensor between = LogLossBetweenMaps(maps, target.maps, scene.batch, {});
  const Tensor rendered =
      LogLossBatch(same_maps, RenderBatch(target.maps, scene.batch), {}, {}, scene.batch, {});
  EXPECT_NEAR(between.item<double>(), rendered.item<double>(), 1e-6);
  between.backward();
  rendered.backward();
  EXPECT_TRUE(torch::allclose(maps.grad(), same_maps.grad(), 1e-5, 1e-12));
}

TEST(RenderAutogradTest, GradientsPassThroughAndMapsNeedNotBeContiguous) {
  const Scene scene = MakeScene(7, ReflectanceConvention::Photograph());
  const Tensor plain = Variable(scene.maps), lying = Variable(scene.maps.transpose(2, 3));
  LogLossBatch(plain, scene.images, {}, {}, scene.batch, {}).backward();
  LogLossBatch(lying.transpose(2, 3), scene.images, {}, {}, scene.batch, {}).backward();
  EXPECT_TRUE(torch::equal(plain.grad(), lying.grad().transpose(2, 3)));
  RenderBatch(lying.transpose(2, 3), scene.batch).sum().backward();
  EXPECT_TRUE(lying.grad().isfinite().all().item<bool>());
}

TEST(RenderAutogradTest, ThreadsDoNotChangeABit) {
  const Scene scene = MakeScene(8, ReflectanceConvention::Photograph(), 3, 2, 77, 150);
  const auto gradient = [&](int threads) {
    torch::set_num_threads(threads);
    const Tensor maps = Variable(scene.maps);
    LogLossBatch(maps, scene.images, scene.masks, {}, scene.batch, {}).backward();
    return maps.grad();
  };
  const Tensor one = gradient(1);
  for (const int threads : {2, 4}) EXPECT_TRUE(torch::equal(gradient(threads), one));
  torch::set_num_threads(1);
}

TEST(RenderAutogradTest, WrongShapesAreNamed) {
  const Scene scene = MakeScene(9, ReflectanceConvention::Photograph());
  const auto message = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const c10::Error& error) {
      return error.what_without_backtrace();
    }
    return "accepted";
  };
  EXPECT_NE(message([&] { RenderBatch(scene.maps.slice(1, 0, 9), scene.batch); }).find("maps"),
            std::string::npos);
  EXPECT_NE(message([&] { RenderBatch(scene.maps.slice(0, 0, 1), scene.batch); }).find("views"),
            std::string::npos);
  EXPECT_NE(message([&] {
              LogLossBatch(scene.maps, scene.images.slice(1, 0, 2), {}, {}, scene.batch, {});
            }).find("images"),
            std::string::npos);
  EXPECT_NE(message([&] { RenderBatch(scene.maps.to(torch::kFloat64), scene.batch); }).find("maps"),
            std::string::npos);
  EXPECT_NE(message([&] {
              LogLossBatch(scene.maps, scene.images, torch::zeros_like(scene.masks), {},
                           scene.batch, {});
            }).find("masks"),
            std::string::npos);
}

}  // namespace
}  // namespace glint
