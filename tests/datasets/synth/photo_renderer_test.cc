#include "datasets/synth/photo_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/reflectance/brdf.h"
#include "datasets/procedural/material.h"

namespace glint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

SvbrdfMaps UniformMaps(float diffuse, float specular, float roughness, int size = 16) {
  SvbrdfMaps maps(size, size);
  const auto fill = [&](int plane, float value) {
    for (float& v : maps.plane(plane)) v = value;
  };
  fill(kNormalZ, 1);
  for (int c = 0; c < 3; ++c) {
    fill(kDiffuseR + c, diffuse);
    fill(kSpecularR + c, specular);
  }
  fill(kRoughness, roughness);
  return maps;
}

CapturePlan SmallPlan(double megapixels = 0.3) {
  CapturePlanOptions options;
  options.seed = 11;
  options.photos = 3;
  options.megapixels = megapixels;
  return PlanCapture(options);
}

struct Picture {
  int width;
  std::vector<float> rgb;
  float green(int x, int y) const { return rgb[3 * (static_cast<size_t>(y) * width + x) + 1]; }
};

Picture Render(const CapturePlan& plan, const SvbrdfMaps& maps, int photo) {
  const PhotoRenderer renderer(plan, maps, 1);
  Picture picture{plan.camera.width_px, {}};
  picture.rgb.resize(static_cast<size_t>(3) * plan.camera.width_px * plan.camera.height_px);
  renderer.RenderRows(photo, 0, plan.camera.height_px, picture.rgb);
  return picture;
}

Vector2d Pixel(const CapturePlan& plan, int photo, double x_mm, double y_mm) {
  return ImageFromCamera(plan.camera,
                         plan.photos[photo].camera_from_sample * Vector3d(x_mm, y_mm, 0));
}

// Lambertian radiance of the plane at a point.
double Lambert(const CapturePlan& plan, int photo, double albedo, double x_mm, double y_mm) {
  const Vector3d to_light = plan.photos[photo].light_in_sample_mm - Vector3d(x_mm, y_mm, 0);
  return albedo / std::numbers::pi * plan.light_rgb[1] * to_light.z() /
         std::pow(to_light.norm(), 3);
}

TEST(PhotoRenderer, PaperInkAndSampleHaveTheRadianceOfTheirAlbedo) {
  const CapturePlan plan = SmallPlan();
  const double square = plan.board.square_mm;
  for (int photo = 0; photo < 3; ++photo) {
    const Picture picture = Render(plan, UniformMaps(0.4f, 0, 0.5f), photo);
    const auto expect = [&](double x_mm, double y_mm, double albedo) {
      const Vector2d p = Pixel(plan, photo, x_mm, y_mm);
      const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
      const double expected = Lambert(plan, photo, albedo, x_mm, y_mm);
      EXPECT_NEAR(picture.green(x, y), expected, 0.01 * expected) << photo << " " << albedo;
    };
    expect(8.5 * square, -6.5 * square, kInkAlbedo);  // corner square, bottom right
    expect(0, 7.4 * square, kPaperAlbedo);            // margin
    // A specular albedo of 0 still reflects a little by Fresnel's term, about 1e-5 here.
    expect(20, -30, 0.4);
  }
}

// Where anti-aliased edges lie, to a fiftieth of a pixel: an edge's position along a row is the
// sum of coverage. This pins the half-pixel convention, the distortion and the pose.
TEST(PhotoRenderer, EdgesLieWhereTheCameraProjectsThem) {
  CapturePlan plan = SmallPlan(3);
  plan.light_rgb.setZero();  // lit evenly, so that radiance is coverage
  plan.ambient_rgb.setConstant(3);
  const PhotoRenderer renderer(plan, UniformMaps(0.4f, 0, 0.5f), 1);
  const double square = plan.board.square_mm;
  Picture row_picture{plan.camera.width_px, std::vector<float>(3 * plan.camera.width_px)};
  for (int photo = 0; photo < 3; ++photo) {
    for (const double column : {-8.0, -7.0, 8.0}) {
      for (const double row : {-5.5, 4.5, 5.5}) {
        // The middle of the edge between squares (column − 1) and (column).
        const Vector2d middle = Pixel(plan, photo, column * square, row * square);
        const int y = static_cast<int>(middle.y());
        const int centre = static_cast<int>(middle.x());
        constexpr int kReach = 4;  // pixels each way; within the squares' marker-free border
        renderer.RenderRows(photo, y, 1, row_picture.rgb);
        const double left = row_picture.green(centre - kReach, 0);
        const double right = row_picture.green(centre + kReach, 0);
        ASSERT_GT(std::abs(left - right), 0.1);
        double coverage = 0;  // of the left side
        for (int x = centre - kReach; x <= centre + kReach; ++x) {
          coverage += (row_picture.green(x, 0) - right) / (left - right);
        }
        const double edge_x = centre - kReach + coverage;
        // The edge's x at the row's middle: follow the edge from the projected middle.
        const Vector2d above = Pixel(plan, photo, column * square, (row + 0.1) * square);
        const double slope = (above.x() - middle.x()) / (above.y() - middle.y());
        const double expected_x = middle.x() + slope * (y + 0.5 - middle.y());
        EXPECT_NEAR(edge_x, expected_x, 0.02) << photo << " " << column << " " << row;
      }
    }
  }
}

TEST(PhotoRenderer, HighlightOfASmoothSampleLiesAtTheMirrorPoint) {
  CapturePlan plan = SmallPlan();
  const Picture picture = Render(plan, UniformMaps(0.0f, 0.04f, 0.2f), 0);
  Vector2d brightest;
  float peak = 0;
  for (int y = 0; y < plan.camera.height_px; ++y) {
    for (int x = 0; x < plan.camera.width_px; ++x) {
      if (picture.green(x, y) > peak) {
        peak = picture.green(x, y);
        brightest = {x + 0.5, y + 0.5};
      }
    }
  }
  const Vector3d camera = Inverse(plan.photos[0].camera_from_sample).translation;
  const Vector3d& light = plan.photos[0].light_in_sample_mm;
  const Vector3d mirror = (light.z() * camera + camera.z() * light) / (light.z() + camera.z());
  const Vector2d expected = Pixel(plan, 0, mirror.x(), mirror.y());
  EXPECT_LT((brightest - expected).norm(), 3);
}

// Root mean square difference between a picture and a four times finer one averaged down, relative
// to the picture's mean.
double DifferenceToFiner(const SvbrdfMaps& maps) {
  const CapturePlan coarse = SmallPlan(0.1875), fine = SmallPlan(3);
  EXPECT_EQ(4 * coarse.camera.width_px, fine.camera.width_px);
  const Picture a = Render(coarse, maps, 1), b = Render(fine, maps, 1);
  double squares = 0, mean = 0;
  const int pixels = coarse.camera.width_px * coarse.camera.height_px;
  for (int y = 0; y < coarse.camera.height_px; ++y) {
    for (int x = 0; x < coarse.camera.width_px; ++x) {
      double sum = 0;
      for (int i = 0; i < 16; ++i) sum += b.green(4 * x + i % 4, 4 * y + i / 4);
      squares += (a.green(x, y) - sum / 16) * (a.green(x, y) - sum / 16);
      mean += sum / 16 / pixels;
    }
  }
  return std::sqrt(squares / pixels) / mean;
}

TEST(PhotoRenderer, EdgesDoNotAlias) {
  EXPECT_LT(DifferenceToFiner(UniformMaps(0.4f, 0.04f, 0.5f)), 0.01);
}

TEST(PhotoRenderer, ReliefAndHighlightsDoNotAlias) {
  EXPECT_LT(DifferenceToFiner(MakeMaterial("leather", 5, 256, 256)), 0.015);
}

}  // namespace
}  // namespace glint
