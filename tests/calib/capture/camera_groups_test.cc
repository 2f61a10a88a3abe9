#include "calib/capture/camera_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace glint {
namespace {

// As upright pictures; `orientation` by EXIF.
DetectedPhoto PhotoOf(int width_px, int height_px, int orientation = 1) {
  DetectedPhoto photo;
  photo.name = std::to_string(width_px) + "x" + std::to_string(height_px);
  photo.width_px = width_px;
  photo.height_px = height_px;
  photo.orientation = orientation;
  photo.camera_model = "phone";
  photo.focal_length_35mm = 26;
  return photo;
}

TEST(GroupCameras, TakesPixelsThatWereTurnedForTheSameCamera) {
  // Across; upright by EXIF; upright by its pixels, which EXIF does not tell.
  const std::vector<DetectedPhoto> photos = {PhotoOf(400, 300), PhotoOf(300, 400, 6),
                                             PhotoOf(300, 400)};
  const CameraGroups groups = GroupCameras("capture.toml", "auto", photos);
  ASSERT_EQ(groups.groups.size(), 1u);
  EXPECT_EQ(groups.groups[0].width_px, 400);
  EXPECT_EQ(groups.turns, (std::vector<int>{0, 1, 1}));
  EXPECT_EQ(groups.pixel_turns, (std::vector<int>{0, 0, 1}));
  EXPECT_EQ(groups.surely_turned, (std::vector<bool>{false, false, true}));
}

TEST(GroupCameras, KeepsUprightPhotographsAloneAndOtherLensesApart) {
  const CameraGroups upright =
      GroupCameras("capture.toml", "auto", {PhotoOf(300, 400), PhotoOf(300, 400)});
  ASSERT_EQ(upright.groups.size(), 1u);
  EXPECT_EQ(upright.groups[0].width_px, 300);
  EXPECT_EQ(upright.pixel_turns, (std::vector<int>{0, 0}));
  std::vector<DetectedPhoto> lenses = {PhotoOf(400, 300), PhotoOf(300, 400)};
  lenses[1].focal_length_35mm = 52;
  EXPECT_EQ(GroupCameras("capture.toml", "auto", lenses).groups.size(), 2u);
}

TEST(GroupCameras, CanTakeStoredSizesAsTheyAre) {
  const std::vector<DetectedPhoto> photos = {PhotoOf(400, 300), PhotoOf(300, 400)};
  EXPECT_EQ(GroupCameras("capture.toml", "auto", photos, false).groups.size(), 2u);
}

TEST(ManySizes, OfPhotographsThatWereCroppedByHandAreTold) {
  std::vector<DetectedPhoto> photos;
  photos.reserve(6);
  for (int i = 0; i < 6; ++i) photos.push_back(PhotoOf(400 - 7 * i, 300 - 3 * i));
  for (DetectedPhoto& photo : photos) photo.detection.corners.resize(1);
  EXPECT_THAT(ManySizesInWords(photos),
              ::testing::HasSubstr("6 photographs have 6 different sizes"));
  for (DetectedPhoto& photo : photos) photo.detection.corners.clear();  // no board: not of it
  EXPECT_EQ(ManySizesInWords(photos), "");
}

TEST(ManySizes, OfUprightPhotographsAndTwoCamerasAreNone) {
  std::vector<DetectedPhoto> photos = {PhotoOf(400, 300), PhotoOf(300, 400), PhotoOf(640, 480)};
  for (DetectedPhoto& photo : photos) photo.detection.corners.resize(1);
  EXPECT_EQ(ManySizesInWords(photos), "");
}

}  // namespace
}  // namespace glint
