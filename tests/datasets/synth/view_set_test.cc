#include "datasets/synth/view_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/formats/capture.h"
#include "base/formats/svbrdf_file.h"
#include "base/photos/photo.h"
#include "datasets/procedural/material.h"
#include "fitting/render/renderer.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

TEST(PlanViews, DirRuleIsDirs) {
  ViewSetOptions options;
  options.count = 50;
  const PlannedViews planned = PlanViews(options, 3, 64, 64);
  EXPECT_EQ(planned.convention, ReflectanceConvention::Dir2019());
  EXPECT_EQ(planned.plane.x_mm(0), -1);
  EXPECT_EQ(planned.plane.y_mm(0), 1);
  EXPECT_EQ(planned.views[0].camera_in_sample_mm, (Vec3d{0, 0, kDirHeight}));
  double widest = 0;
  for (const View& view : planned.views) {
    EXPECT_EQ(view.camera_in_sample_mm, view.light_in_sample_mm);
    EXPECT_EQ(view.camera_in_sample_mm[2], kDirHeight);
    widest = std::max(
        {widest, std::abs(view.camera_in_sample_mm[0]), std::abs(view.camera_in_sample_mm[1])});
  }
  EXPECT_LE(widest, kDirJitter);
  EXPECT_GT(widest, 0.9 * kDirJitter);
}

TEST(PlanViews, SetsOfOneSeedAreNestedAndOthersDiffer) {
  for (const std::string rule : {"dir", "photo"}) {
    ViewSetOptions options;
    options.rule = rule;
    options.count = 4;
    const PlannedViews few = PlanViews(options, 9, 32, 32);
    const PlannedViews other = PlanViews(options, 10, 32, 32);
    options.count = 20;
    const PlannedViews many = PlanViews(options, 9, 32, 32);
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(few.views[i].camera_in_sample_mm, many.views[i].camera_in_sample_mm);
      EXPECT_EQ(few.views[i].light_rgb, many.views[i].light_rgb);
    }
    EXPECT_NE(few.views[3].camera_in_sample_mm, other.views[3].camera_in_sample_mm);
  }
}

TEST(RenderPlannedView, EightBitsAreWithinHalfALevelOfTheRendering) {
  const SvbrdfMaps maps = MakeMaterial(21, 64, 64);
  for (const std::string encoding : {"gamma2.2", "linear"}) {
    ViewSetOptions options;
    options.encoding = encoding;
    const PlannedViews planned = PlanViews(options, 1, 64, 64);
    const RectifiedImage eight = RenderPlannedView(maps, planned, 2, options, 1);
    options.bits = "float";
    const RectifiedImage exact = RenderPlannedView(maps, planned, 2, options, 1);
    std::vector<float> rendered(exact.rgb.size());
    RenderView(maps, planned.plane, planned.views[2], planned.convention, rendered.data());
    EXPECT_EQ(exact.rgb, rendered);
    const double exponent = encoding == "linear" ? 1 : 1 / 2.2;
    double worst = 0;
    for (size_t i = 0; i < rendered.size(); ++i) {
      const double clipped = std::clamp(rendered[i], 0.0f, 1.0f);
      worst =
          std::max(worst, std::abs(std::pow(eight.rgb[i], exponent) - std::pow(clipped, exponent)));
    }
    EXPECT_LE(worst, 0.5 / 255 + 1e-5) << encoding;
    EXPECT_GT(worst, 0.4 / 255) << encoding;  // it is quantised
  }
}

TEST(WriteViewSet, ReadsBackAsARectifiedSetAndACapture) {
  const test::TemporaryFolder temporary;
  const fs::path& folder = temporary.path();
  const MaterialSource material{"m", MakeMaterial(5, 32, 32)};
  CommonOptions common;
  common.threads = 1;
  common.seed = 8;
  for (const std::string bits : {"8", "float"}) {
    ViewSetOptions options;
    options.count = 3;
    options.bits = bits;
    options.rule = "photo";
    WriteViewSet(folder / bits, material, options, common);
    EXPECT_EQ(ReadCapture(folder / bits).photos.size(), 3u);
    const RectifiedSet set = ReadRectifiedSet(folder / bits / "glint/rectify/manifest.json");
    ASSERT_EQ(set.views.size(), 3u);
    EXPECT_EQ(set.views[1].ldr, bits == "8");
    EXPECT_EQ(set.convention, ReflectanceConvention::Photograph());
    const PlannedViews planned = PlanViews(options, 8, 32, 32);
    EXPECT_EQ(set.views[1].view.camera_in_sample_mm, planned.views[1].camera_in_sample_mm);
    const RectifiedImage image = ReadRectifiedImage(set, set.views[1]);
    const std::vector<float> exact = RenderPlannedView(material.maps, planned, 1, options, 2).rgb;
    // Views of 8 bits are kept as half floats, which round by up to 2⁻¹¹.
    const float rounding = bits == "float" ? 0.0f : 1.0f / 2048;
    ASSERT_EQ(image.rgb.size(), exact.size());
    // The photograph says the same as the rectified view.
    const Photo photo = ReadPhoto(folder / bits / set.views[1].photo);
    EXPECT_EQ(photo.is_float(), bits == "float");
    const Image shown = photo.image.Planes();
    for (size_t i = 0; i < image.rgb.size(); ++i) {
      const float stored = shown.samples[i];
      const float linear = bits == "float" ? stored : std::pow(stored, 2.2f);
      ASSERT_NEAR(image.rgb[i], exact[i], rounding * exact[i]);
      ASSERT_NEAR(linear, exact[i], 1e-6);
    }
    EXPECT_EQ(ReadSvbrdf(folder / bits / "truth/svbrdf.exr").planes, material.maps.planes);
  }
}

}  // namespace
}  // namespace glint
