#include "rectify/views/rectify_photo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors/errors.h"
#include "tests/rectify/plane_photo.h"

namespace glint {
namespace {

using testing::HasSubstr;

SamplePlane SmallPlane() {
  SamplePlane plane;
  plane.width = plane.height = 40;
  plane.width_mm = plane.height_mm = 40;
  return plane;
}

std::string MessageFor(const Photo& photo, const Rigid3& pose) {
  ViewCounts counts;
  try {
    RectifyPhoto(LinearPhoto(photo, Encoding::kGamma22),
                 CameraProjection(TestCamera(300, 300), pose), SmallPlane(), {}, {}, "photos/a.jpg",
                 &counts);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(RectifyPhoto, NamesWhatMakesAPhotoUseless) {
  const Rigid3 pose = LookAtSample(100, 10, 0);
  EXPECT_THAT(
      MessageFor(FlatPhoto(300, 300, 1.0f, 8), pose),
      testing::AllOf(HasSubstr("photos/a.jpg"), HasSubstr("saturated"), HasSubstr("expose")));
  EXPECT_THAT(MessageFor(FlatPhoto(300, 300, 0.0f, 8), pose),
              testing::AllOf(HasSubstr("photos/a.jpg"), HasSubstr("black"), HasSubstr("flash")));
  Rigid3 aside = pose;
  aside.translation.x() = 150;
  EXPECT_THAT(
      MessageFor(FlatPhoto(300, 300, 0.5f, 8), aside),
      testing::AllOf(HasSubstr("photos/a.jpg"), HasSubstr("outside"), HasSubstr("size_mm")));
  EXPECT_EQ(MessageFor(FlatPhoto(300, 300, 0.5f, 8), pose), "");
}

TEST(RectifyPhoto, CountsWhereTexelsWent) {
  Rigid3 aside = LookAtSample(100, 0, 0);
  // 3 px a mm; the principal point is 153.2 px from the left, so that 20 mm reach 93.2 px: 31.07 mm
  // further and the photo's left edge cuts the sample in its middle.
  aside.translation.x() = -153.2 / 3;
  ViewCounts counts;
  const RectifiedImage image = RectifyPhoto(
      LinearPhoto(FlatPhoto(300, 300, 0.5f, 8), Encoding::kGamma22),
      CameraProjection(TestCamera(300, 300), aside), SmallPlane(), {}, {}, "a.jpg", &counts);
  EXPECT_NEAR(counts.outside, 0.5, 1e-9);
  EXPECT_NEAR(counts.usable, 0.5, 1e-9);
  EXPECT_NEAR(counts.pixels_per_texel, 3, 1e-9);
  EXPECT_EQ(image.mask[20 * 40 + 5], 0);
  EXPECT_EQ(image.mask[20 * 40 + 35], 1);
}

// A view that is written by rows is the view.
TEST(RectifyPhoto, RowsAreThoseOfTheWhole) {
  Image waves = FlatImage(300, 300, 0.5f);
  for (size_t i = 0; i < waves.samples.size(); ++i) {
    waves.samples[i] += 0.4f * std::sin(0.01f * static_cast<float>(i));
  }
  const LinearPhoto linear(PhotoOf(waves, 8), Encoding::kGamma22);
  const CameraProjection projection(TestCamera(300, 300), LookAtSample(100, 20, 0));
  SamplePlane plane = SmallPlane();
  plane.height = kRowsAtOnce + 100;
  plane.width = 24;
  const FrameStatus frame = [](const SamplePlane& rows) {
    std::vector<TexelStatus> status;
    for (int i = 0; i < rows.width * rows.height; ++i) {
      const bool covered = rows.y_mm(i / rows.width) < -15;
      status.push_back(covered ? TexelStatus::kMasked : TexelStatus::kOutside);
    }
    return status;
  };
  ViewCounts counts;
  const RectifiedImage whole = RectifyPhoto(linear, projection, plane, {}, frame, "a.jpg", &counts);
  size_t texels = 0;
  const ViewCounts by_rows =
      RectifyByRows(linear, projection, plane, {}, frame, "a.jpg", [&](const RectifiedImage& rows) {
        const size_t count = rows.mask.size();
        for (size_t i = 0; i < count; ++i) {
          ASSERT_EQ(rows.mask[i], whole.mask[texels + i]);
          ASSERT_EQ(rows.rgb[count + i], whole.rgb[whole.mask.size() + texels + i]);
        }
        texels += count;
      });
  EXPECT_EQ(texels, whole.mask.size());
  EXPECT_EQ(ToJson(by_rows), ToJson(counts));
  EXPECT_GT(counts.masked, 0.1);
}

TEST(RectifyPhoto, PutsCameraAndLightIntoTheSampleFrame) {
  Calibration calibration;
  calibration.light_rgb = {3, 2, 1};
  CalibratedPhoto photo;
  photo.camera_from_sample = LookAtSample(250, 0, 0);
  photo.light_in_camera_mm = {10, 20, -3};  // image right, image down, behind the lens
  const View view = ViewOf(calibration, photo, {0.1, 0.2, 0.3}, "manifest.json");
  EXPECT_EQ(view.camera_in_sample_mm, (Vec3d{0, 0, 250}));
  EXPECT_EQ(view.light_in_sample_mm, (Vec3d{10, -20, 253}));
  EXPECT_EQ(view.light_rgb, (Vec3d{3, 2, 1}));
  EXPECT_EQ(view.ambient_rgb, (Vec3d{0.1, 0.2, 0.3}));
  photo.light_in_camera_mm = {0, 0, 300};
  EXPECT_THROW(ViewOf(calibration, photo, {0, 0, 0}, "manifest.json"), UserError);
}

}  // namespace
}  // namespace glint
