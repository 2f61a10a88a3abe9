// glint-calib with poses from COLMAP, as a person runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <random>

#include "base/camera/orientation.h"
#include "base/camera/similarity3.h"
#include "base/formats/calibration.h"
#include "base/formats/manifest.h"
#include "base/images/image.h"
#include "calib/colmap/colmap_camera.h"
#include "calib/colmap/colmap_model.h"
#include "tests/calib/testing/synthetic_photo.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using testing::LookAt;

constexpr int kPhotos = 6;
const Camera kCamera{CameraModel::kRadial, 640, 480, {560, 323.3, 237.1, 0.06, -0.08}};

Rigid3 Pose(int index) { return LookAt(230 + 5 * index, 5 + 6 * index, 100 * index, 20 * index); }

std::string Name(int index) { return "photos/p" + std::to_string(index) + ".png"; }

// COLMAP's frame is any: turned, moved and in a unit of its own.
Similarity3 ModelFromSample() {
  Similarity3 similarity;
  similarity.scale = 1 / 41.0;
  similarity.rotation =
      Eigen::AngleAxisd(2.3, Vector3d(1, -0.4, 0.7).normalized()).toRotationMatrix();
  similarity.translation = {0.3, -2, 4};
  return similarity;
}

// What COLMAP would make of a flat sample of 300 mm with things scattered over it: noise of 0.03 mm
// in the points and a third of them off the plane.
ColmapModel ModelOf(double scattered_share = 0.33) {
  ColmapModel model;
  model.cameras = {ToColmapCamera(kCamera, 1)};
  for (int i = 0; i < kPhotos; ++i) {
    ColmapImage image;
    image.id = static_cast<std::uint32_t>(i + 1);
    image.camera_id = 1;
    image.name = "p" + std::to_string(i) + ".png";
    image.set_camera_from_model(MovedPose(Pose(i), ModelFromSample()));
    model.images.push_back(image);
  }
  std::mt19937 generator(3);
  const auto unit = [&] { return 2 * (generator() / 4294967296.0) - 1; };
  for (int k = 0; k < 600; ++k) {
    const bool off = unit() < 2 * scattered_share - 1;
    const Vector3d at_mm(120 * unit(), 90 * unit(), off ? 60 * unit() : 0.03 * unit());
    ColmapPoint point;
    point.id = static_cast<std::uint64_t>(k) + 1;
    point.position = ModelFromSample() * at_mm;
    for (int i = 0; i < kPhotos; ++i) {
      const Vector2d seen = ImageFromCamera(kCamera, Pose(i) * at_mm);
      if (seen.minCoeff() < 0 || seen.x() > 640 || seen.y() > 480) continue;
      auto& observations = model.images[i].observations;
      point.track.push_back(
          {static_cast<std::uint32_t>(i + 1), static_cast<std::uint32_t>(observations.size())});
      observations.push_back({seen, point.id});
    }
    model.points.push_back(point);
  }
  return model;
}

Vector2d Pixel(int photo, double x_mm, double y_mm) {
  return testing::Project(kCamera, Pose(photo), {x_mm, y_mm});
}

std::string Toml(const std::string& poses, const std::string& more = "") {
  return "[sample]\nsize_mm = [40, 30]\n[photos]\nfiles = [\"photos/*.png\"]\n[light]\noffset_mm = "
         "[12, 0, 0]\n" +
         (poses.empty() ? "" : "[poses]\n" + poses) + more;
}

std::string List(const std::vector<Vector2d>& points) {
  std::string text;
  for (const Vector2d& point : points) {
    text += (text.empty() ? "[" : ", ") + ("[" + std::to_string(point.x())) + ", " +
            std::to_string(point.y()) + "]";
  }
  return text + "]";
}

std::string Corners(int photo) {
  return "photo = \"" + Name(photo) + "\"\ncorners_px = " +
         List({Pixel(photo, -20, 15), Pixel(photo, 20, 15), Pixel(photo, 20, -15),
               Pixel(photo, -20, -15)}) +
         "\n";
}

class ColmapPoses : public ::testing::Test {
 protected:
  void SetUp() override {
    Image grey(640, 480, {"R", "G", "B"});
    for (float& value : grey.samples) value = 0.3f;
    fs::create_directories(capture() / "photos");
    for (int i = 0; i < kPhotos; ++i) WritePng(capture() / Name(i), grey);
    fs::create_directories(model());
    WriteColmapModel(model(), ModelOf(), ColmapFormat::kBinary);
  }

  fs::path capture() const { return folder_.path() / "wood"; }
  fs::path model() const { return folder_.path() / "model"; }

  test::Outcome Calibrate(const std::string& toml, std::vector<std::string> options = {}) const {
    test::WriteAll(capture() / "capture.toml", toml);
    std::vector<std::string> arguments{std::string(GLINT_BIN_DIR) + "/glint-calib",
                                       capture().string(), "--poses", "colmap:" + model().string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return test::RunProgram(arguments);
  }

  Calibration Result() const { return ReadCalibration(capture() / "glint/calib/manifest.json"); }

  // Camera centres relative to their distance, in percent, and the rotation in degrees.
  void ExpectTruePoses(double percent, double degrees) const {
    const Calibration calibration = Result();
    ASSERT_EQ(calibration.photos.size(), static_cast<size_t>(kPhotos));
    for (int i = 0; i < kPhotos; ++i) {
      const CalibratedPhoto& photo = calibration.photos[static_cast<size_t>(i)];
      EXPECT_EQ(photo.photo, Name(i));
      const Vector3d right = Inverse(Pose(i)).translation;
      const Vector3d found = Inverse(photo.camera_from_sample).translation;
      EXPECT_LT(100 * (found - right).norm() / right.norm(), percent) << i;
      const Eigen::Matrix3d turn = photo.camera_from_sample.rotation.transpose() * Pose(i).rotation;
      EXPECT_LT(Eigen::AngleAxisd(turn).angle() * 180 / M_PI, degrees) << i;
      EXPECT_EQ(photo.light_in_camera_mm, Vector3d(12, 0, 0));
      EXPECT_LT(photo.rms_px, 0.2);
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(ColmapPoses, TheSamplesCornersGiveFrameAndScale) {
  const test::Outcome outcome = Calibrate(Toml(Corners(2)));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ExpectTruePoses(0.1, 0.1);
  EXPECT_FALSE(Result().light_power_known);
  EXPECT_EQ(Result().cameras[0].parameters, kCamera.parameters);
  const Json metrics = ReadManifest(capture() / "glint/calib/manifest.json").metrics;
  EXPECT_EQ(metrics["poses"]["scale_from"], "corners");
  EXPECT_NEAR(metrics["poses"]["mm_per_unit"].get<double>(), 41, 0.05);
  EXPECT_GT(metrics["poses"]["plane_share"].get<double>(), 0.5);
  // Nothing to do the second time, and something when the model changes.
  EXPECT_THAT(Calibrate(Toml(Corners(2))).out, HasSubstr("up to date"));
  ColmapModel other = ModelOf();
  other.points.pop_back();
  for (ColmapImage& image : other.images) {
    for (ColmapObservation& o : image.observations) {
      if (o.point_id == 600) o.point_id = kNoColmapPoint;
    }
  }
  WriteColmapModel(model(), other, ColmapFormat::kBinary);
  EXPECT_THAT(Calibrate(Toml(Corners(2))).out, HasSubstr("poses from COLMAP"));
}

TEST_F(ColmapPoses, LengthsGiveTheScaleAndPixelsTheFrame) {
  const std::string frame = "photo = \"" + Name(1) + "\"\norigin_px = [" +
                            std::to_string(Pixel(1, 0, 0).x()) + ", " +
                            std::to_string(Pixel(1, 0, 0).y()) +
                            "]\nx_axis_px = " + List({Pixel(1, -30, 0), Pixel(1, 30, 0)}) + "\n";
  const double apart = (Inverse(Pose(0)).translation - Inverse(Pose(5)).translation).norm();
  const double height = Inverse(Pose(1)).translation.z();
  for (const std::string& length :
       {"points_mm = 50\npoints_px = " + List({Pixel(1, -15, -20), Pixel(1, 15, 20)}) + "\n",
        "cameras = [\"" + Name(0) + "\", \"" + Name(5) +
            "\"]\ncameras_mm = " + std::to_string(apart) + "\n",
        "height_mm = " + std::to_string(height) + "\n"}) {
    const test::Outcome outcome = Calibrate(Toml(frame + length));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    ExpectTruePoses(0.15, 0.1);
  }
}

TEST_F(ColmapPoses, WithoutWordOnTheFrameTheSampleLiesWherePhotographsLook) {
  ASSERT_EQ(Calibrate(Toml("height_mm = 240\n")).code, 0);
  const Calibration calibration = Result();
  const CalibratedPhoto& first = calibration.photos[0];  // the steepest
  // All look at (0, 0): its picture is the middle, and x is the photograph's right.
  const Vector2d middle = ImageFromCamera(kCamera, first.camera_from_sample.translation);
  EXPECT_NEAR(middle.x(), 323, 6);
  EXPECT_NEAR(middle.y(), 237, 6);
  EXPECT_GT(first.camera_from_sample.rotation(0, 0), 0.99);
  for (const CalibratedPhoto& photo : calibration.photos) {
    EXPECT_GT(Inverse(photo.camera_from_sample).translation.z(), 100);
  }
}

TEST_F(ColmapPoses, TheModelIsKeptInTheSamplesFrameAndExported) {
  ASSERT_EQ(Calibrate(Toml(Corners(2)), {"--export", "colmap"}).code, 0);
  const ColmapModel exported = ReadColmapModel(capture() / "glint/colmap");
  EXPECT_EQ(exported.images[3].name, Name(3));
  EXPECT_LT((exported.images[3].camera_from_model().translation - Pose(3).translation).norm(), 0.3);
  EXPECT_EQ(exported.points.size(), 600u);
}

TEST_F(ColmapPoses, ForeignLensesAreConvertedWithTheirErrorStated) {
  ColmapModel fisheye = ModelOf();
  fisheye.cameras[0] = {1,
                        *ColmapModelFromName("THIN_PRISM_FISHEYE"),
                        640,
                        480,
                        {560, 560, 323.3, 237.1, 0.3, 0.1, 0, 0, 0, 0, 0, 0}};
  WriteColmapModel(model(), fisheye, ColmapFormat::kBinary);
  ASSERT_EQ(Calibrate(Toml(Corners(2))).code, 0);
  EXPECT_EQ(Result().cameras[0].model, CameraModel::kFullOpenCv);
  const Json poses = ReadManifest(capture() / "glint/calib/manifest.json").metrics["poses"];
  EXPECT_LT(poses["converted_cameras"][0]["largest_px"].get<double>(), 0.1);
  EXPECT_GT(poses["converted_cameras"][0]["largest_px"].get<double>(), 0);
}

TEST_F(ColmapPoses, ABoardInSomePhotographsGivesScaleAndFrame) {
  const Board board = testing::SmallBoard();
  for (const int i : {0, 2, 3}) {
    testing::PhotoSettings settings;
    settings.samples = 2;
    testing::WritePhoto(capture() / Name(i), Photograph(board, kCamera, Pose(i), settings));
  }
  const test::Outcome outcome =
      Calibrate(Toml("",
                     "[board]\nkind = \"charuco\"\nsquares = [8, 6]\nsquare_mm = 20\nmarker_mm = "
                     "12\ndictionary = \"DICT_5X5_100\"\n"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ExpectTruePoses(0.1, 0.1);
  EXPECT_THAT(outcome.out, HasSubstr("scale from board"));
}

// COLMAP ignores EXIF's orientation; somebody who turned the files first gives it upright ones.
TEST_F(ColmapPoses, ATurnedPhotographsPoseIsThatOfTheUprightPicture) {
  fs::remove(capture() / Name(1));
  OIIO::ImageSpec spec(640, 480, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Orientation", 6);  // a quarter turn clockwise
  const std::vector<unsigned char> grey(3 * 640 * 480, 90);
  const auto file = OIIO::ImageOutput::create("x.jpg");
  ASSERT_TRUE(file->open((capture() / "photos/p1.jpg").string(), spec));
  ASSERT_TRUE(file->write_image(OIIO::TypeDesc::UINT8, grey.data()) && file->close());
  std::string toml = Toml(Corners(2));
  toml.replace(toml.find("photos/*.png"), 12, "photos/*.*g");
  for (const bool upright : {false, true}) {
    ColmapModel turned = ModelOf();
    ColmapImage& image = turned.images[1];
    image.name = "p1.jpg";
    if (upright) {
      turned.cameras.push_back(ToColmapCamera(TurnedCamera(kCamera, 1), 2));
      image.camera_id = 2;
      image.set_camera_from_model(TurnedPose(image.camera_from_model(), 1));
      for (ColmapObservation& o : image.observations) {
        o.point_px = TurnedImagePoint(o.point_px, 640, 480, 1);
      }
    }
    WriteColmapModel(model(), turned, ColmapFormat::kBinary);
    const test::Outcome outcome = Calibrate(toml);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Calibration calibration = Result();
    const CalibratedPhoto& photo = calibration.photos[1];
    EXPECT_EQ(calibration.cameras[static_cast<size_t>(photo.camera)].width_px, 480);
    const Rigid3 right = TurnedPose(Pose(1), 1);
    EXPECT_LT((photo.camera_from_sample.translation - right.translation).norm(), 0.3);
    EXPECT_TRUE(photo.camera_from_sample.rotation.isApprox(right.rotation, 2e-3));
    EXPECT_EQ(photo.light_in_camera_mm, TurnedCameraPoint(Vector3d(12, 0, 0), 1));
    EXPECT_LT(photo.rms_px, 0.2);
    // What is exported is of the stored pictures, as COLMAP will read them.
    ASSERT_EQ(Calibrate(toml, {"--export", "colmap"}).code, 0);
    EXPECT_EQ(ReadColmapModel(capture() / "glint/colmap").images[1].name, "photos/p1.jpg");
  }
}

TEST_F(ColmapPoses, ModelsOfOtherPhotographsAreRefused) {
  ColmapModel other = ModelOf();
  for (ColmapImage& image : other.images) image.name = "IMG_" + image.name;
  WriteColmapModel(model(), other, ColmapFormat::kBinary);
  test::Outcome outcome = Calibrate(Toml(Corners(2)));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("IMG_p0.png"));
  EXPECT_THAT(outcome.err, HasSubstr("photos/p0.png"));

  other = ModelOf();
  other.cameras[0].width_px = 1280;
  WriteColmapModel(model(), other, ColmapFormat::kBinary);
  outcome = Calibrate(Toml(Corners(2)));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("1280x480 pixels, while photos/p0.png has 640x480"));
}

TEST_F(ColmapPoses, APhotographThatTheModelLacksIsLeftOutWithAWord) {
  ColmapModel fewer = ModelOf();
  fewer.images[4].name = "helper.png";
  WriteColmapModel(model(), fewer, ColmapFormat::kBinary);
  const test::Outcome outcome = Calibrate(Toml(Corners(2)));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("photos/p4.png is left out: the COLMAP model"));
  EXPECT_EQ(Result().photos.size(), 5u);
}

// A library's intrinsics would have been ignored without a word.
TEST_F(ColmapPoses, IntrinsicsFromElsewhereAreRefused) {
  for (const std::string option : {"--library", "--fix-intrinsics"}) {
    const test::Outcome outcome = Calibrate(Toml(Corners(2)), {option, folder_.path().string()});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(option.substr(2) + ": found "));
    EXPECT_THAT(outcome.err, HasSubstr("leave one out"));
  }
}

TEST_F(ColmapPoses, NoPlaneNoScaleAndWrongCornersSayWhatToDo) {
  const test::Outcome no_scale = Calibrate(Toml(""));
  EXPECT_EQ(no_scale.code, 2);
  EXPECT_THAT(no_scale.err, HasSubstr("corners_px"));
  EXPECT_THAT(no_scale.err, HasSubstr("height_mm"));

  const std::string swapped =
      "photo = \"" + Name(0) + "\"\ncorners_px = " +
      List({Pixel(0, 20, 15), Pixel(0, -20, 15), Pixel(0, -20, -15), Pixel(0, 20, -15)}) + "\n";
  const test::Outcome mirrored = Calibrate(Toml(swapped));
  EXPECT_EQ(mirrored.code, 2);
  EXPECT_THAT(mirrored.err, HasSubstr("poses.corners_px: found corners that run anticlockwise"));

  WriteColmapModel(model(), ModelOf(1), ColmapFormat::kBinary);
  const test::Outcome scattered = Calibrate(Toml("height_mm = 240\n"));
  EXPECT_EQ(scattered.code, 2);
  EXPECT_THAT(scattered.err, HasSubstr("points3D: found the points scattered"));

  ColmapModel without_points = ModelOf();
  without_points.points.clear();
  for (ColmapImage& image : without_points.images) image.observations.clear();
  WriteColmapModel(model(), without_points, ColmapFormat::kBinary);
  const test::Outcome bare = Calibrate(Toml("height_mm = 240\n"));
  EXPECT_EQ(bare.code, 2);
  EXPECT_THAT(bare.err, HasSubstr("points3D: found no points; give the model with its points"));
}

TEST_F(ColmapPoses, BadModelFilesAreNamed) {
  const std::string images = test::ReadAll(model() / "images.bin");
  test::WriteAll(model() / "images.bin", images.substr(0, images.size() / 2));
  test::Outcome outcome = Calibrate(Toml(Corners(2)));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("images.bin: image"));
  fs::remove(model() / "images.bin");
  outcome = Calibrate(Toml(Corners(2)));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("images.bin: found no such file"));
  EXPECT_FALSE(fs::exists(capture() / "glint/calib/manifest.json"));
}

TEST_F(ColmapPoses, AMissingProgramIsTheEnvironmentsFaultAndSaysHowToInstallIt) {
  test::WriteAll(capture() / "capture.toml", Toml("height_mm = 240\n"));
  const test::Outcome outcome = test::RunProgram(
      {std::string(GLINT_BIN_DIR) + "/glint-calib", capture().string(), "--poses", "colmap"},
      [] { ::setenv("PATH", "/nonexistent", 1); });
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("apt-get install --no-install-recommends colmap"));
}

// A program in colmap's place: what it is called with, and what becomes of its failure.
TEST_F(ColmapPoses, AFailingProgramIsReportedWithItsLog) {
  test::WriteAll(capture() / "capture.toml", Toml("height_mm = 240\n"));
  const fs::path program = folder_.path() / "bin/colmap";
  test::WriteAll(program,
                 "#!/bin/sh\necho \"$QT_QPA_PLATFORM $*\"\n"
                 "[ $1 = mapper ] && { echo 'no good initial image pair'; exit 1; }\n"
                 "exit 0\n");
  fs::permissions(program, fs::perms::owner_all);
  const std::string path = program.parent_path().string() + ":/usr/bin:/bin";
  const test::Outcome outcome = test::RunProgram(
      {std::string(GLINT_BIN_DIR) + "/glint-calib", capture().string(), "--poses", "colmap"},
      [&] { ::setenv("PATH", path.c_str(), 1); });
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("no good initial image pair"));
  EXPECT_THAT(outcome.err, HasSubstr("glint/colmap-run/log.txt"));
  const std::string log = test::ReadAll(capture() / "glint/colmap-run/log.txt");
  EXPECT_THAT(log, HasSubstr("offscreen feature_extractor"));
  EXPECT_THAT(log, HasSubstr("--SiftExtraction.use_gpu 0"));
  EXPECT_THAT(log, HasSubstr("exhaustive_matcher"));
  EXPECT_EQ(test::ReadAll(capture() / "glint/colmap-run/images.txt").substr(0, 17),
            "camera0/0000.png\n");
}

}  // namespace
}  // namespace glint
