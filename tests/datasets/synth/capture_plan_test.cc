#include "datasets/synth/capture_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors/errors.h"

namespace glint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double Tilt_deg(const PlannedPhoto& photo) {
  return std::acos(-photo.camera_from_sample.rotation(2, 2)) * 180 / std::numbers::pi;
}

TEST(FrameBoard, FitsA4AndHoldsTheSample) {
  const Board board = FrameBoard(100);
  EXPECT_EQ(CheckBoard(board), "");
  EXPECT_LE(board.squares_x * board.square_mm, 297 - 10);
  EXPECT_LE(board.squares_y * board.square_mm, 210 - 10);
  EXPECT_GT(board.window->columns * board.square_mm, 100);
  // The window is in the middle, so that the sample's centre is the board's.
  EXPECT_EQ(2 * board.window->first_column + board.window->columns, board.squares_x);
  EXPECT_EQ(2 * board.window->first_row + board.window->rows, board.squares_y);
}

TEST(PlanCapture, FirstPhotoIsATopViewAndTheOthersComeFromAllSides) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CapturePlanOptions options;
    options.seed = seed;
    const CapturePlan plan = PlanCapture(options);
    ASSERT_EQ(plan.photos.size(), 12u);
    EXPECT_LT(Tilt_deg(plan.photos[0]), 3);
    double steepest = 0;
    Vector2d mean_direction(0, 0);
    for (const PlannedPhoto& photo : plan.photos) {
      steepest = std::max(steepest, Tilt_deg(photo));
      const Vector3d camera = Inverse(photo.camera_from_sample).translation;
      mean_direction += camera.head<2>().normalized() / 12;
    }
    EXPECT_GT(steepest, 25);
    EXPECT_LE(steepest, 41);
    EXPECT_LT(mean_direction.norm(), 0.4);
  }
}

TEST(PlanCapture, PhotosAreTakenFromWhereTheyAreAsked) {
  CapturePlanOptions options;
  options.directions = {{0, 0}, {25, 90}, {35, 180}};
  options.photos = 3;
  const CapturePlan plan = PlanCapture(options);
  // The point that the camera looks at is a little beside the sample's centre.
  const auto is_near = [&](size_t photo, double x, double y) {
    const Vector3d axis = plan.photos[photo].camera_from_sample.rotation.row(2);
    EXPECT_NEAR(-axis.x(), x, 1e-9);
    EXPECT_NEAR(-axis.y(), y, 1e-9);
  };
  is_near(0, 0, 0);
  is_near(1, 0, std::sin(25 * std::numbers::pi / 180));
  is_near(2, -std::sin(35 * std::numbers::pi / 180), 0);
  options.photos = 4;
  EXPECT_THROW(PlanCapture(options), UserError);
}

TEST(PlanCapture, SampleIsInEveryPictureAndUpright) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CapturePlanOptions options;
    options.seed = seed;
    const CapturePlan plan = PlanCapture(options);
    for (const PlannedPhoto& photo : plan.photos) {
      const auto pixel = [&](double x, double y) {
        return ImageFromCamera(plan.camera, photo.camera_from_sample * Vector3d(x, y, 0));
      };
      for (const double x : {-50.0, 50.0}) {
        for (const double y : {-50.0, 50.0}) {
          const Vector2d p = pixel(x, y);
          EXPECT_TRUE(p.x() > 0 && p.x() < plan.camera.width_px && p.y() > 0 &&
                      p.y() < plan.camera.height_px);
        }
      }
      EXPECT_LT(pixel(0, 50).y(), pixel(0, -50).y());  // +y of the sample is up
      EXPECT_LT(pixel(-50, 0).x(), pixel(50, 0).x());
    }
  }
}

TEST(PlanCapture, ExposuresSpreadOverTheStopsAndTheBrightestPaperKeepsItsLevel) {
  CapturePlanOptions options;
  options.exposure_ev = 1;
  options.exif_error = 0.03;
  options.seed = 3;
  const CapturePlan plan = PlanCapture(options);
  EXPECT_EQ(plan.photos[0].exposure, 1);
  double least = 1e9, most = 0, brightest = 0, deviation = 0;
  for (const PlannedPhoto& photo : plan.photos) {
    least = std::min(least, photo.exposure);
    most = std::max(most, photo.exposure);
    const Vector3d& light = photo.light_in_sample_mm;
    const double falloff = 1 / (light.z() * light.z());
    brightest = std::max(
        brightest, photo.exposure * plan.light_rgb.x() * falloff * kPaperAlbedo / std::numbers::pi);
    deviation = std::max(deviation, std::abs(photo.exif_exposure / photo.exposure - 1));
  }
  EXPECT_NEAR(most / least, 4, 1e-9);
  EXPECT_NEAR(brightest, options.paper_level, 0.05);
  EXPECT_GT(deviation, 0.005);
  EXPECT_LT(deviation, 0.12);
}

TEST(PlanCapture, CornersLoseWhatVignettingSaysAndTheTruthsPolynomialFollows) {
  CapturePlanOptions options;
  options.vignetting = 0.3;
  const CapturePlan plan = PlanCapture(options);
  const Camera& camera = plan.camera;
  const Vector2d centre(camera.parameters[1], camera.parameters[2]);
  const Vector2d half(0.5 * camera.width_px, 0.5 * camera.height_px);
  EXPECT_EQ(LensFalloff(plan, centre), 1);
  EXPECT_NEAR(LensFalloff(plan, centre + half), 0.7, 1e-12);
  for (double r = 0; r <= 1; r += 0.05) {
    EXPECT_NEAR(Vignetting(camera, centre + r * half), LensFalloff(plan, centre + r * half), 3e-4);
  }
}

TEST(PlanCapture, FlashSitsAtItsOffsetInTheCameraFrame) {
  CapturePlanOptions options;
  options.flash_offset_mm = {7, -12, 3};
  for (const PlannedPhoto& photo : PlanCapture(options).photos) {
    const Vector3d light = photo.camera_from_sample * photo.light_in_sample_mm;
    EXPECT_LT((light - Vector3d(7, -12, 3)).norm(), 1e-9);
  }
}

TEST(PlanCapture, BrightestPaperReachesTheLevel) {
  CapturePlanOptions options;
  options.ambient = 0.2;
  const CapturePlan plan = PlanCapture(options);
  double brightest = 0;
  for (const PlannedPhoto& photo : plan.photos) {
    for (double x = -117; x <= 117; x += 1) {
      for (double y = -91; y <= 91; y += 1) {
        const Vector3d to_light = photo.light_in_sample_mm - Vector3d(x, y, 0);
        const double flash = plan.light_rgb[0] * to_light.z() / std::pow(to_light.norm(), 3);
        brightest =
            std::max(brightest, kPaperAlbedo / std::numbers::pi * (flash + plan.ambient_rgb[0]));
      }
    }
  }
  EXPECT_NEAR(brightest, options.paper_level, 2e-3);
}

TEST(PlanCapture, MegapixelsScaleThePictureAndNothingElse) {
  CapturePlanOptions options;
  const CapturePlan large = PlanCapture(options);
  options.megapixels = 0.75;
  const CapturePlan small = PlanCapture(options);
  EXPECT_EQ(large.camera.width_px, 4000);
  EXPECT_EQ(large.camera.height_px, 3000);
  EXPECT_EQ(small.camera.width_px, 1000);
  const Camera scaled = ScaledCamera(large.camera, 0.25);
  for (size_t i = 0; i < scaled.parameters.size(); ++i) {
    EXPECT_NEAR(scaled.parameters[i], small.camera.parameters[i], 1e-9);
  }
  EXPECT_NEAR(large.light_rgb[0], small.light_rgb[0], 1e-9 * large.light_rgb[0]);
}

TEST(PlanCapture, ImpossibleOptionsAreUserErrors) {
  const auto rejects = [](auto change) {
    CapturePlanOptions options;
    change(&options);
    EXPECT_THROW(PlanCapture(options), UserError);
  };
  rejects([](auto* o) { o->photos = 0; });
  rejects([](auto* o) { o->megapixels = 1000; });
  rejects([](auto* o) { o->nearest_mm = 50; });
  rejects([](auto* o) { o->farthest_mm = 10; });
  rejects([](auto* o) { o->flash_offset_mm = {0, 0, 400}; });
  rejects([](auto* o) { o->flash_tint = {1, 0, 1}; });
}

}  // namespace
}  // namespace glint
