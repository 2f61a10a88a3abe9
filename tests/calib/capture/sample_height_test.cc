// Synthetic captures whose photographs are changed as if the sample lay higher or lower.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/formats/calibration.h"
#include "base/formats/manifest.h"
#include "calib/registration/sample_place.h"
#include "tests/calib/testing/synthetic_capture.h"

namespace glint {
namespace {

using ::testing::HasSubstr;

constexpr double kSide_mm = 100;

class SampleHeight : public testing::SyntheticCapture {
 protected:
  static void SetUpTestSuite() {
    Make({"--megapixels", "2", "--photos", "9", "--texels", "512", "--family", "wood", "--seed",
          "5"});
  }

  // Every photograph as if the sample lay in that plane; `plain`: it is one colour, and fills the
  // board's window of 104 mm.
  void Lay(const PlaneValues& plane, bool plain = false) const {
    const Calibration truth = ReadCalibration(Shared() / "truth/calib/manifest.json");
    const Rigid3 board_from_sample = AssumedFromSample(plane);
    for (const CalibratedPhoto& photo : truth.photos) {
      const Camera& camera = truth.cameras[static_cast<size_t>(photo.camera)];
      const Rigid3 camera_from_sample = photo.camera_from_sample * board_from_sample;
      const Rigid3 sample_from_camera = Inverse(camera_from_sample);
      const cv::Mat before = cv::imread((Shared() / photo.photo).string());
      cv::Mat columns(before.size(), CV_32F), rows(before.size(), CV_32F), found;
      cv::Mat inside = cv::Mat::zeros(before.size(), CV_8U);
      for (int y = 0; y < before.rows; ++y) {
        for (int x = 0; x < before.cols; ++x) {
          const auto ray = NormalizedFromImage(camera, {x + 0.5, y + 0.5});
          if (!ray) continue;
          const Eigen::Vector3d direction = sample_from_camera.rotation * ray->homogeneous();
          const Eigen::Vector3d& from = sample_from_camera.translation;
          const Eigen::Vector3d at = from - from.z() / direction.z() * direction;
          if (at.head<2>().cwiseAbs().maxCoeff() > (plain ? 51.9 : kSide_mm / 2)) continue;
          const Eigen::Vector2d flat = ImageFromCamera(
              camera, photo.camera_from_sample * Eigen::Vector3d(at.x(), at.y(), 0));
          columns.at<float>(y, x) = static_cast<float>(flat.x() - 0.5);
          rows.at<float>(y, x) = static_cast<float>(flat.y() - 0.5);
          inside.at<unsigned char>(y, x) = 255;
        }
      }
      cv::remap(before, found, columns, rows, cv::INTER_CUBIC, cv::BORDER_REFLECT);
      if (plain) found.setTo(cv::Scalar(90, 100, 110));
      cv::Mat after = before.clone();
      found.copyTo(after, inside);
      ASSERT_TRUE(
          cv::imwrite((capture_ / photo.photo).string(), after, {cv::IMWRITE_JPEG_QUALITY, 95}));
    }
  }

  test::Outcome Calibrate(const std::string& height = "") const {
    if (!height.empty()) {
      std::string toml = test::ReadAll(capture_ / "capture.toml");
      toml.insert(toml.find("size_mm"), "height_mm = " + height + "\n");
      test::WriteAll(capture_ / "capture.toml", toml);
    }
    return test::RunProgram({testing::Program("glint-calib"), capture_.string()});
  }

  Json Plane() const {
    return ReadManifest(capture_ / "glint/calib/manifest.json").metrics["sample_plane"];
  }

  void ExpectFound(const PlaneValues& plane) const {
    const Json found = Plane();
    EXPECT_TRUE(found["told_by_texture"].get<bool>());
    EXPECT_NEAR(found["height_mm"].get<double>(), plane[0], 0.15);
    EXPECT_LT(std::abs(found["height_mm"].get<double>() - plane[0]),
              3 * found["height_sd_mm"].get<double>());
    for (size_t i = 0; i < 2; ++i) {
      EXPECT_LT(std::abs(found["slope"][i].get<double>() - plane[i + 1]),
                3 * found["slope_sd"][i].get<double>());
    }
  }
};

TEST_F(SampleHeight, FlatSamplesLieExactlyInTheBoardsPlane) {
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Plane()["height_mm"].get<double>(), 0);
  const Calibration calibration = ReadCalibration(capture_ / "glint/calib/manifest.json");
  EXPECT_TRUE(calibration.board_from_sample.rotation.isIdentity(0));
  for (const CalibratedPhoto& photo : calibration.photos) {
    EXPECT_TRUE(photo.registration.isIdentity(0));
  }
}

TEST_F(SampleHeight, ThickAndTiltedSamplesAreFoundAndSaidSo) {
  const PlaneValues plane{3, 0.0175, 0};
  Lay(plane);
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("mm above the board, tilted by 1.0°"));
  ExpectFound(plane);
}

TEST_F(SampleHeight, SamplesUnderTheFrameAreFound) {
  const PlaneValues plane{-2, 0, 0};
  Lay(plane);
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("below the board"));
  ExpectFound(plane);
}

TEST_F(SampleHeight, CamerasAreThoseOfTheSamplesOwnPlane) {
  const PlaneValues plane{8, 0, 0};
  Lay(plane);
  ASSERT_EQ(Calibrate().code, 0);
  const Calibration truth = ReadCalibration(Shared() / "truth/calib/manifest.json");
  const Calibration found = ReadCalibration(capture_ / "glint/calib/manifest.json");
  for (size_t i = 0; i < truth.photos.size(); ++i) {
    const double right_mm = Inverse(truth.photos[i].camera_from_sample).translation.z() - 8;
    EXPECT_NEAR(Inverse(found.photos[i].camera_from_sample).translation.z(), right_mm, 0.5);
  }
}

TEST_F(SampleHeight, PlainSamplesStayWhereTheyAreSaidToBe) {
  Lay({0, 0, 0}, true);
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("too little texture"));
  EXPECT_THAT(outcome.out, HasSubstr("height_mm"));
  EXPECT_FALSE(Plane()["told_by_texture"].get<bool>());
  EXPECT_EQ(Plane()["height_mm"].get<double>(), 0);
  ASSERT_EQ(Calibrate("3").code, 0);
  EXPECT_EQ(Plane()["height_mm"].get<double>(), 3);
}

TEST_F(SampleHeight, ZeroKeepsTheSampleInTheBoardsPlane) {
  Lay({3, 0, 0});
  ASSERT_EQ(Calibrate("0").code, 0);
  EXPECT_EQ(Plane()["height_mm"].get<double>(), 0);
}

TEST_F(SampleHeight, OtherWordsAreRefused) {
  const test::Outcome outcome = Calibrate("\"thick\"");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("sample.height_mm"));
  EXPECT_THAT(outcome.err, HasSubstr("auto"));
}

}  // namespace
}  // namespace glint
