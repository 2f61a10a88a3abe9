// Synthetic captures whose photographs are changed as if the sample lay elsewhere, or were another
// one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/formats/calibration.h"
#include "base/formats/manifest.h"
#include "calib/colmap/colmap_camera.h"
#include "calib/colmap/colmap_model.h"
#include "calib/registration/sample_place.h"
#include "tests/calib/testing/synthetic_capture.h"

namespace glint {
namespace {

using ::testing::HasSubstr;

constexpr double kSide_mm = 100;

class SamplesPlace : public testing::SyntheticCapture {
 protected:
  static void SetUpTestSuite() {
    Make({"--megapixels", "2", "--photos", "9", "--texels", "512", "--family", "marble", "--seed",
          "5"});
  }

  // What happens to the sample from a photograph on.
  struct Later {
    size_t from = 100;
    SampleMove move;
    bool another = false;
  };

  // Every photograph as if the sample lay in that plane; `plain`: it is one colour, and fills the
  // board's window of 104 mm.
  void Lay(const PlaneValues& plane, bool plain = false) const { Lay(plane, plain, {}); }
  void Lay(const PlaneValues& plane, bool plain, const Later& later) const {
    const Calibration truth = ReadCalibration(Shared() / "truth/calib/manifest.json");
    const Rigid3 board_from_sample = AssumedFromSample(plane);
    for (size_t i = 0; i < truth.photos.size(); ++i) {
      const CalibratedPhoto& photo = truth.photos[i];
      const bool is_later = i >= later.from;
      const Camera& camera = truth.cameras[static_cast<size_t>(photo.camera)];
      const Rigid3 camera_from_sample = photo.camera_from_sample *
                                        (is_later ? later.move : SampleMove{}).Motion() *
                                        board_from_sample;
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
          const bool across = is_later && later.another;  // its texture is another one, so laid
          const Eigen::Vector3d shown(across ? at.y() : at.x(), across ? at.x() : at.y(), 0);
          const Eigen::Vector2d flat = ImageFromCamera(camera, photo.camera_from_sample * shown);
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

  // With the true poses as COLMAP's, and the board's scale.
  test::Outcome CalibrateFromColmap() const {
    const Calibration truth = ReadCalibration(Shared() / "truth/calib/manifest.json");
    ColmapModel model;
    model.cameras = {ToColmapCamera(truth.cameras.front(), 1)};
    for (const CalibratedPhoto& photo : truth.photos) {
      ColmapImage& image = model.images.emplace_back();
      image.id = static_cast<std::uint32_t>(model.images.size());
      image.camera_id = 1;
      image.name = std::filesystem::path(photo.photo).filename().string();
      image.set_camera_from_model(photo.camera_from_sample);
    }
    for (int k = 0; k < 100; ++k) {
      const int column = k % 10, row = k / 10;
      ColmapPoint& point = model.points.emplace_back();
      point.id = static_cast<std::uint64_t>(k) + 1;
      point.position = {10 * column - 45.0, 10 * row - 45.0, 0};
      for (size_t i = 0; i < truth.photos.size(); ++i) {
        auto& observations = model.images[i].observations;
        point.track.push_back(
            {model.images[i].id, static_cast<std::uint32_t>(observations.size())});
        observations.push_back(
            {ImageFromCamera(truth.cameras.front(),
                             truth.photos[i].camera_from_sample * point.position),
             point.id});
      }
    }
    std::filesystem::create_directories(capture_ / "model");
    WriteColmapModel(capture_ / "model", model, ColmapFormat::kBinary);
    return test::RunProgram({testing::Program("glint-calib"), capture_.string(), "--poses",
                             "colmap:" + (capture_ / "model").string()});
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

TEST_F(SamplesPlace, FlatSamplesLieExactlyInTheBoardsPlane) {
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Plane()["height_mm"].get<double>(), 0);
  const Calibration calibration = ReadCalibration(capture_ / "glint/calib/manifest.json");
  EXPECT_TRUE(calibration.board_from_sample.rotation.isIdentity(0));
  EXPECT_TRUE(Plane()["moved"].empty());
  for (const CalibratedPhoto& photo : calibration.photos) {
    EXPECT_TRUE(photo.registration.isIdentity(0));
  }
}

TEST_F(SamplesPlace, ThickAndTiltedSamplesAreFoundAndSaidSo) {
  const PlaneValues plane{3, 0.0175, 0};
  Lay(plane);
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("mm above the board, tilted by (0.9|1.0|1.1)"));
  ExpectFound(plane);
}

TEST_F(SamplesPlace, SamplesUnderTheFrameAreFound) {
  const PlaneValues plane{-2, 0, 0};
  Lay(plane);
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("below the board"));
  ExpectFound(plane);
}

TEST_F(SamplesPlace, CamerasAreThoseOfTheSamplesOwnPlane) {
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

TEST_F(SamplesPlace, SamplesThatWereMovedAreFollowed) {
  const Later later{.from = 5, .move = {0.035, {2, 1}}, .another = false};
  Lay({0, 0, 0}, false, later);
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the sample was moved between photographs"));
  EXPECT_EQ(Plane()["height_mm"].get<double>(), 0);
  EXPECT_EQ(Plane()["moved"].size(), 4u);
  const Calibration truth = ReadCalibration(Shared() / "truth/calib/manifest.json");
  const Calibration found = ReadCalibration(capture_ / "glint/calib/manifest.json");
  ASSERT_EQ(found.photos.size(), truth.photos.size());
  for (size_t i = 0; i < truth.photos.size(); ++i) {
    const SampleMove move = i >= later.from ? later.move : SampleMove{};
    const Rigid3 moved = truth.photos[i].camera_from_sample * move.Motion();
    EXPECT_LT((Inverse(found.photos[i].camera_from_sample).translation - Inverse(moved).translation)
                  .norm(),
              0.5)
        << i;
    // Where the photograph shows a corner of the sample, as registered.
    const Eigen::Vector3d corner(40, 40, 1);
    const Eigen::Vector2d place = (found.photos[i].registration * corner).hnormalized();
    const Eigen::Vector3d there =
        found.photos[i].camera_from_sample * Eigen::Vector3d(place.x(), place.y(), 0);
    const Eigen::Vector3d expected = moved * Eigen::Vector3d(40, 40, 0);
    EXPECT_LT((there - expected).head<2>().norm(), 0.25) << i;
  }
}

TEST_F(SamplesPlace, PhotographsOfAnotherSampleAreLeftOutByName) {
  Lay({0, 0, 0}, false, {.from = 7, .move = {}, .another = true});
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("photo_007.jpg is left out: shows another sample than"));
  EXPECT_THAT(outcome.err, HasSubstr("photo_008.jpg is left out: shows another sample than"));
  EXPECT_EQ(ReadCalibration(capture_ / "glint/calib/manifest.json").photos.size(), 7u);
}

// Nothing else tells them apart there: they stay, and are named.
TEST_F(SamplesPlace, PhotographsOfAnotherSampleAreNamedWherePosesAreGiven) {
  const test::Outcome alike = CalibrateFromColmap();
  ASSERT_EQ(alike.code, 0) << alike.err;
  EXPECT_THAT(alike.err, ::testing::Not(HasSubstr("another sample")));
  Lay({0, 0, 0}, false, {.from = 7, .move = {}, .another = true});
  const test::Outcome outcome = CalibrateFromColmap();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("is seen in photos/photo_007.jpg, photos/photo_008.jpg:"));
  EXPECT_THAT(outcome.err, HasSubstr("Name them in [photos] left_out"));
  const Calibration found = ReadCalibration(capture_ / "glint/calib/manifest.json");
  EXPECT_EQ(found.photos.size(), 9u);
}

TEST_F(SamplesPlace, PlainSamplesStayWhereTheyAreSaidToBe) {
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

TEST_F(SamplesPlace, ZeroKeepsTheSampleInTheBoardsPlane) {
  Lay({3, 0, 0});
  ASSERT_EQ(Calibrate("0").code, 0);
  EXPECT_EQ(Plane()["height_mm"].get<double>(), 0);
}

TEST_F(SamplesPlace, OtherWordsAreRefused) {
  const test::Outcome outcome = Calibrate("\"thick\"");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("sample.height_mm"));
  EXPECT_THAT(outcome.err, HasSubstr("auto"));
}

}  // namespace
}  // namespace glint
