// Photographs that an app straightened are told from those that it did not, even where the first
// solution goes with the wrong ones.
#include "calib/validation/consensus.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/calib/testing/board_scene.h"

namespace glint {
namespace {

using testing::MakeScene;
using testing::PhoneCamera;
using testing::Scene;

Scene SixPhotographs() {
  testing::SceneSettings settings;
  settings.photos = 6;
  settings.tilt_scale = 0.5;
  settings.noise_px = 0.05;
  settings.seed = 4;
  return MakeScene(PhoneCamera(CameraModel::kOpenCv), settings);
}

// As an editor makes converging lines parallel.
void Straighten(double strength, BundlePhoto* photo) {
  for (BundleCorner& corner : photo->corners) {
    const Eigen::Vector2d from = (corner.point_px - Eigen::Vector2d(2000, 1500)) / 2000;
    const double scale = 1 / (1 + strength * (0.8 * from.x() + from.y()));
    corner.point_px = Eigen::Vector2d(2000, 1500) + 2000 * scale * from;
  }
}

size_t Rejected(const BundleResult& result) {
  return static_cast<size_t>(
      std::count_if(result.photos.begin(), result.photos.end(),
                    [](const PhotoEstimate& photo) { return !photo.rejected.empty(); }));
}

std::vector<size_t> PhotosOf(const std::vector<OddPhoto>& odd) {
  std::vector<size_t> photos;
  photos.reserve(odd.size());
  for (const OddPhoto& one : odd) photos.push_back(one.photo);
  return photos;
}

TEST(Consensus, FindsTheTwoThatWereStraightened) {
  Scene scene = SixPhotographs();
  Straighten(0.1, &scene.problem.photos[1]);
  Straighten(0.1, &scene.problem.photos[3]);
  const BundleResult result = AdjustBundle(scene.problem);
  ASSERT_EQ(Rejected(result), 4u);  // two good ones left, too
  const std::vector<OddPhoto> odd = OddPhotos(scene.problem, {}, result, 2);
  EXPECT_EQ(PhotosOf(odd), (std::vector<size_t>{1, 3}));
  for (const OddPhoto& one : odd) EXPECT_FALSE(one.reason.empty());
  const std::vector<OddPhoto> alone = OddPhotos(scene.problem, {}, result, 1);
  ASSERT_EQ(alone.size(), odd.size());
  for (size_t i = 0; i < odd.size(); ++i) EXPECT_EQ(alone[i].reason, odd[i].reason);
}

TEST(Consensus, GoodPhotographsStay) {
  const Scene scene = SixPhotographs();
  EXPECT_TRUE(OddPhotos(scene.problem, {}, AdjustBundle(scene.problem), 2).empty());
}

TEST(Consensus, OneThatLeavesByItselfIsNotLookedInto) {
  Scene scene = SixPhotographs();
  Straighten(0.05, &scene.problem.photos[3]);
  const BundleResult result = AdjustBundle(scene.problem);
  EXPECT_EQ(Rejected(result), 1u);
  EXPECT_TRUE(OddPhotos(scene.problem, {}, result, 2).empty());
}

}  // namespace
}  // namespace glint
