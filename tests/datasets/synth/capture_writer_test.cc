#include "datasets/synth/capture_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>

#include "base/errors/errors.h"
#include "base/formats/calibration.h"
#include "base/formats/capture.h"
#include "base/formats/svbrdf_file.h"
#include "base/images/image.h"
#include "base/photos/photo.h"
#include "datasets/procedural/material.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

class CaptureWriterTest : public testing::Test {
 protected:
  void SetUp() override {
    options_.plan.photos = 2;
    options_.plan.megapixels = 0.2;
    options_.plan.seed = 4;
    material_ = {"stone", MakeMaterial("stone", 4, 64, 64)};
  }

  static std::map<std::string, std::string> Files(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream stream(entry.path(), std::ios::binary);
      files[entry.path().lexically_relative(folder).generic_string()] = {
          std::istreambuf_iterator<char>(stream), {}};
    }
    return files;
  }

  test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path() / "capture";
  SyntheticCaptureOptions options_;
  MaterialSource material_;
};

TEST_F(CaptureWriterTest, IsACaptureThatReadsAsItWasMade) {
  WriteSyntheticCapture(folder_, material_, options_, 1);
  const Capture capture = ReadCapture(folder_);
  const Board board = FrameBoard(100);
  EXPECT_EQ(capture.photos.size(), 2u);
  EXPECT_EQ(capture.sample_size_mm, (std::array<double, 2>{100, 100}));
  EXPECT_EQ(capture.board.squares_x, board.squares_x);
  EXPECT_EQ(capture.board.squares_y, board.squares_y);
  EXPECT_EQ(capture.board.square_mm, board.square_mm);
  EXPECT_EQ(capture.board.marker_mm, board.marker_mm);
  EXPECT_EQ(capture.board.window->first_column, board.window->first_column);
  EXPECT_EQ(capture.encoding, "gamma2.2");
  EXPECT_EQ(capture.light_offset_mm, options_.plan.flash_offset_mm);
  EXPECT_EQ(capture.light_power, (std::array<double, 3>{0, 0, 0}));  // not given away
}

TEST_F(CaptureWriterTest, TruthIsThePlan) {
  WriteSyntheticCapture(folder_, material_, options_, 1);
  const CapturePlan plan = PlanCapture(options_.plan);
  const Calibration truth = ReadCalibration(folder_ / "truth" / "calib" / "manifest.json");
  EXPECT_EQ(truth.cameras[0].parameters, plan.camera.parameters);
  EXPECT_EQ(truth.light_rgb, plan.light_rgb);
  ASSERT_EQ(truth.photos.size(), 2u);
  EXPECT_EQ(truth.photos[1].photo, ReadCapture(folder_).photos[1]);
  EXPECT_EQ(truth.photos[1].camera_from_sample.translation,
            plan.photos[1].camera_from_sample.translation);
  EXPECT_EQ(ReadSvbrdf(folder_ / "truth" / "svbrdf.exr").planes, material_.maps.planes);
}

TEST_F(CaptureWriterTest, PhotographsCarryTheFocalLength) {
  WriteSyntheticCapture(folder_, material_, options_, 1);
  const Photo photo = ReadPhoto(folder_ / "photos" / "photo_000.jpg");
  const CapturePlan plan = PlanCapture(options_.plan);
  EXPECT_EQ(photo.bits, 8);
  EXPECT_EQ(photo.image.width, plan.camera.width_px);
  // 35 mm equivalent by the diagonal, rounded to a millimetre as cameras do.
  EXPECT_NEAR(photo.focal_length_35mm,
              plan.camera.focal_length_x() / (1.25 * plan.camera.width_px) * 43.267, 0.51);
  EXPECT_GT(photo.exposure_time_s, 0);
}

TEST_F(CaptureWriterTest, SameBytesForAnyNumberOfThreads) {
  WriteSyntheticCapture(folder_ / "one", material_, options_, 1);
  WriteSyntheticCapture(folder_ / "three", material_, options_, 3);
  EXPECT_EQ(Files(folder_ / "one"), Files(folder_ / "three"));
}

TEST_F(CaptureWriterTest, LinearFormatKeepsRadianceAboveOne) {
  options_.format = "exr";
  options_.plan.paper_level = 1.5;
  options_.noise.scale = 0;
  WriteSyntheticCapture(folder_, material_, options_, 1);
  const Photo photo = ReadPhoto(folder_ / "photos" / "photo_000.exr");
  EXPECT_TRUE(photo.is_float());
  float largest = 0;
  const Image shown = photo.image.Planes();
  for (const float sample : shown.samples) largest = std::max(largest, sample);
  EXPECT_GT(largest, 1.3f);
  EXPECT_EQ(ReadCapture(folder_).encoding, "linear");
}

TEST_F(CaptureWriterTest, DoesNotReplaceACaptureUnlessTold) {
  WriteSyntheticCapture(folder_, material_, options_, 1);
  const auto before = Files(folder_);
  options_.plan.photos = 1;
  EXPECT_THROW(WriteSyntheticCapture(folder_, material_, options_, 1), UserError);
  EXPECT_EQ(Files(folder_), before);
  options_.overwrite = true;
  WriteSyntheticCapture(folder_, material_, options_, 1);
  EXPECT_EQ(ReadCapture(folder_).photos.size(), 1u);
}

TEST_F(CaptureWriterTest, WithoutABoardTheTableHasAPatternAndTheCornersAreTold) {
  options_.plan.has_board = false;
  options_.format = "exr";
  WriteSyntheticCapture(folder_, material_, options_, 1);
  const Capture capture = ReadCapture(folder_);
  EXPECT_FALSE(capture.has_board);
  const CapturePlan plan = PlanCapture(options_.plan);
  const Eigen::Vector2d top_left =
      ImageFromCamera(plan.camera, plan.photos[0].camera_from_sample * Eigen::Vector3d(-50, 50, 0));
  ASSERT_EQ(capture.poses.corners_px.size(), 8u);
  EXPECT_NEAR(capture.poses.corners_px[0], top_left.x(), 0.051);
  EXPECT_NEAR(capture.poses.corners_px[1], top_left.y(), 0.051);
  // The top rows show the table alone: bright and dark spots, a millimetre or more each.
  const Image photo = ReadExr(folder_ / capture.photos[0]);
  float lowest = 1e9f, highest = 0;
  for (int i = 0; i < 20 * photo.width; ++i) {
    lowest = std::min(lowest, photo.samples[static_cast<size_t>(i)]);
    highest = std::max(highest, photo.samples[static_cast<size_t>(i)]);
  }
  EXPECT_GT(highest, 3 * lowest);
}

}  // namespace
}  // namespace glint
