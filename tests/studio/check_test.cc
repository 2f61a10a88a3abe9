// The check of a photograph against a capture whose truth is known.
#include <gtest/gtest.h>

#include "base/files/json_file.h"
#include "pipeline/studio/photographs/photo_check.h"
#include "tests/studio/synthetic.h"

namespace glint {
namespace {

TEST(PhotoCheck, FindsWhereThePhotographsWereTaken) {
  const test::TemporaryFolder folder;
  test::MakeSynthetic(folder / "truth", 4);
  const Capture capture = ReadCapture(folder / "truth");
  const Json truth = ReadJsonFile(folder / "truth/truth/calib/manifest.json", "");
  const CheckTask task = CheckTaskOf(capture);
  size_t i = 0;
  for (const Json& photo : truth["data"]["photos"]) {
    std::string thumbnail;
    const PhotoCheck check = CheckPhoto(capture.folder / capture.photos[i++], task, &thumbnail);
    ASSERT_TRUE(check.board_found) << check.board_problem << check.unreadable;
    ASSERT_TRUE(check.pose);
    EXPECT_EQ(thumbnail.substr(0, 2), "\xff\xd8");
    Rigid3 camera_from_sample;
    const Json& rotation = photo["camera_from_sample"]["rotation"];
    const Json& translation = photo["camera_from_sample"]["translation_mm"];
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        camera_from_sample.rotation(r, c) = rotation[0].is_array()
                                                ? rotation[r][c].get<double>()
                                                : rotation[3 * r + c].get<double>();
      }
      camera_from_sample.translation[r] = translation[r];
    }
    const Eigen::Vector3d camera = Inverse(camera_from_sample).translation;
    const Direction is = DirectionOf(camera), found = DirectionOf(check.pose->camera_in_sample_mm);
    EXPECT_NEAR(found.tilt_deg, is.tilt_deg, 1.5);
    if (is.tilt_deg > 5) {
      EXPECT_NEAR(std::remainder(found.azimuth_deg - is.azimuth_deg, 360), 0, 5);
    }
  }
}

TEST(PhotoCheck, WhatIsNoPictureIsSaidToBeUnreadable) {
  const test::TemporaryFolder folder;
  std::string thumbnail;
  EXPECT_FALSE(CheckPhoto(folder.Write("a.jpg", "text"), {}, &thumbnail).unreadable.empty());
  EXPECT_FALSE(CheckPhoto(folder / "missing.jpg", {}, &thumbnail).unreadable.empty());
}

}  // namespace
}  // namespace glint
