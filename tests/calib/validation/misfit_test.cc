#include "calib/validation/misfit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/calib/testing/board_scene.h"

namespace glint {
namespace {

using ::testing::HasSubstr;

struct Misfit {
  BundleProblem problem;
  BundleOptions options;
  BundleResult result;

  // A phone's photographs, changed before they are calibrated.
  explicit Misfit(const std::function<void(BundleProblem*)>& change) {
    const testing::SceneSettings settings;
    problem = MakeScene(testing::PhoneCamera(options.model), settings).problem;
    change(&problem);
    result = AdjustBundle(problem, options);
  }
};

void ChangePicture(size_t photo, double zoom, const Eigen::Vector2d& shift_px,
                   BundleProblem* problem) {
  const Eigen::Vector2d middle(2000, 1500);
  for (BundleCorner& corner : problem->photos[photo].corners) {
    corner.point_px = middle + zoom * (corner.point_px - middle) + shift_px;
  }
}

TEST(Misfit, ARejectedPhotographsZoomIsFound) {
  for (const double zoom : {0.6, 1.25, 2.0}) {
    const Misfit misfit([&](BundleProblem* problem) { ChangePicture(7, zoom, {0, 0}, problem); });
    const PhotoEstimate& photo = misfit.result.photos[7];
    ASSERT_NE(photo.rejected, "") << zoom;
    const auto view = ExplainByOtherView(misfit.result, photo);
    ASSERT_TRUE(view) << zoom;
    EXPECT_NEAR(view->zoom, zoom, 0.01 * zoom);
    EXPECT_THAT(InWords(*view), HasSubstr("times the others' focal length"));
  }
}

TEST(Misfit, ARejectedPhotographsCropIsFound) {
  const Misfit misfit([](BundleProblem* problem) { ChangePicture(9, 1, {500, -200}, problem); });
  const PhotoEstimate& photo = misfit.result.photos[9];
  ASSERT_NE(photo.rejected, "");
  const auto view = ExplainByOtherView(misfit.result, photo);
  ASSERT_TRUE(view);
  EXPECT_NEAR(view->shift_px.x(), 500, 15);
  EXPECT_NEAR(view->shift_px.y(), -200, 15);
  EXPECT_THAT(InWords(*view), HasSubstr("it was cropped"));
}

// Corners that were mixed up are neither.
TEST(Misfit, WhatNothingExplainsIsNotExplained) {
  const Misfit misfit([](BundleProblem* problem) {
    auto& corners = problem->photos[5].corners;
    for (size_t i = 0; i + 1 < corners.size(); i += 2) {
      std::swap(corners[i].point_px, corners[i + 1].point_px);
    }
  });
  const PhotoEstimate& photo = misfit.result.photos[5];
  ASSERT_NE(photo.rejected, "");
  EXPECT_FALSE(ExplainByOtherView(misfit.result, photo));
}

TEST(Misfit, ABoardThatWasPrintedHigherThanWideIsFound) {
  for (const double stretch : {-0.02, 0.005, 0.03}) {
    const Misfit misfit([&](BundleProblem* problem) {
      // The corners lie where they are; the description has them lower.
      for (BundlePhoto& photo : problem->photos) {
        for (BundleCorner& corner : photo.corners) corner.position_in_sample_mm.y() /= 1 + stretch;
      }
    });
    const BoardStretch found = FindBoardStretch(misfit.problem, misfit.options, misfit.result);
    EXPECT_NEAR(found.relative, stretch, 0.15 * std::abs(stretch));
    EXPECT_THAT(InWords(found), HasSubstr(stretch > 0 ? "% higher" : "% lower"));
  }
}

TEST(Misfit, AGoodBoardIsNotCalledStretched) {
  const Misfit good([](BundleProblem*) {});
  EXPECT_EQ(FindBoardStretch(good.problem, good.options, good.result).relative, 0);
  const Misfit zoomed([](BundleProblem* problem) { ChangePicture(7, 1.25, {0, 0}, problem); });
  EXPECT_EQ(FindBoardStretch(zoomed.problem, zoomed.options, zoomed.result).relative, 0);
}

}  // namespace
}  // namespace glint
