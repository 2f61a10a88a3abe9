// glint-calib as a person runs it: results, errors, and what is left on disk.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/formats/calibration.h"
#include "base/formats/manifest.h"
#include "base/images/image.h"
#include "calib/colmap/colmap_camera.h"
#include "calib/colmap/colmap_model.h"
#include "tests/calib/testing/synthetic_photo.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::LookAt;

constexpr char kCaptureToml[] = R"([sample]
size_mm = [40, 40]
[photos]
files = ["photos/*.png"]
[board]
kind = "charuco"
squares = [8, 6]
square_mm = 20
marker_mm = 12
dictionary = "DICT_5X5_100"
[light]
offset_mm = [12, 0, 0]
)";

const Camera kCamera = testing::SmallCamera();

void WriteText(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

std::string ReadText(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

GrayImage TakePhoto(int index, double tilt_scale = 1) {
  testing::PhotoSettings settings;
  settings.samples = 2;
  settings.seed = index;
  return Photograph(testing::SmallBoard(), kCamera,
                    LookAt(230 + 5 * index, tilt_scale * (6 + 6 * index), 100 * index, 20 * index),
                    settings);
}

struct Result {
  int code = -1;
  std::string output;  // stdout and stderr
};

Result Calibrate(const fs::path& capture, const std::string& options = "") {
  const std::string command =
      std::string(GLINT_BIN_DIR) + "/glint-calib " + capture.string() + " " + options + " 2>&1";
  Result result;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  while (const size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) {
    result.output.append(buffer.data(), n);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) result.code = WEXITSTATUS(status);
  return result;
}

class CalibProgram : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = fs::temp_directory_path() / ("glint_calib_" + std::to_string(::getpid()));
    for (int i = 0; i < 6; ++i) {
      testing::WritePhoto(root_ / "good/photos" / ("p" + std::to_string(i) + ".png"), TakePhoto(i));
    }
    WriteText(root_ / "good/capture.toml", kCaptureToml);
  }
  static void TearDownTestSuite() { fs::remove_all(root_); }

  // A copy of the good capture, with its results where it was calibrated before.
  static fs::path Copy(const std::string& name, bool calibrated = false) {
    fs::create_directories((root_ / name).parent_path());
    fs::copy(root_ / "good", root_ / name, fs::copy_options::recursive);
    if (calibrated) {
      EXPECT_EQ(Calibrate(root_ / name).code, 0);
    } else {
      fs::remove_all(root_ / name / "glint");
    }
    return root_ / name;
  }
  // Exit code 2, all the words, and an earlier result byte for byte as it was.
  static void ExpectUserError(const fs::path& capture, const std::vector<std::string>& words,
                              const std::string& options = "") {
    const fs::path manifest = capture / "glint/calib/manifest.json";
    const std::string before = ReadText(manifest);
    const Result result = Calibrate(capture, options);
    EXPECT_EQ(result.code, 2) << result.output;
    for (const std::string& word : words) EXPECT_THAT(result.output, HasSubstr(word));
    EXPECT_EQ(ReadText(manifest), before);
  }
  static fs::path root_;
};
fs::path CalibProgram::root_;

TEST_F(CalibProgram, CalibratesTheSameForAnyThreadCountAndPlace) {
  const fs::path a = Copy("a"), b = Copy("elsewhere/b");
  const Result first = Calibrate(a, "--threads 1 --light camera"),
               second = Calibrate(b, "--threads 3 --light camera");
  ASSERT_EQ(first.code, 0) << first.output;
  ASSERT_EQ(second.code, 0) << second.output;
  for (const char* name : {"manifest.json", "residuals.json", "residuals_camera0.png"}) {
    EXPECT_FALSE(ReadText(a / "glint/calib" / name).empty()) << name;
    EXPECT_EQ(ReadText(a / "glint/calib" / name), ReadText(b / "glint/calib" / name)) << name;
  }
  const Calibration calibration = ReadCalibration(a / "glint/calib/manifest.json");
  ASSERT_EQ(calibration.photos.size(), 6u);
  EXPECT_NEAR(calibration.cameras[0].focal_length_x() / 560, 1, 0.003);
  EXPECT_EQ(calibration.photos[0].light_in_camera_mm, Eigen::Vector3d(12, 0, 0));
  EXPECT_TRUE(calibration.light_power_known);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(calibration.photos[i].blur_px, 0.75, 0.08);  // of a lens of .7, and the pixel
    const Rigid3 truth = LookAt(230 + 5 * i, 6 + 6 * i, 100 * i, 20 * i);
    const Eigen::Vector3d position = Inverse(truth).translation;
    EXPECT_LT((Inverse(calibration.photos[i].camera_from_sample).translation - position).norm(),
              0.003 * position.norm());
  }
  EXPECT_THAT(Calibrate(a, "--light camera").output, HasSubstr("up to date"));
}

TEST_F(CalibProgram, SaysHowFarTheResultCanBeTrusted) {
  const fs::path capture = Copy("trust");
  const fs::path library = capture / "phones";
  fs::create_directories(library);
  const Result result =
      Calibrate(capture, "--model auto --board-shape bent --library " + library.string());
  ASSERT_EQ(result.code, 0) << result.output;
  for (const char* words :
       {"does not know the camera", "model: ", "at the sample: positions are known",
        "odd/even photographs, camera 0", "board: rises by"}) {
    EXPECT_THAT(result.output, HasSubstr(words));
  }
  const std::string manifest = ReadText(capture / "glint/calib/manifest.json");
  for (const char* field : {"projection_uncertainty", "sample_uncertainty", "cross_validation",
                            "model_choice", "board_bend", "exif_camera"}) {
    EXPECT_THAT(manifest, HasSubstr(field));
  }
  for (const char* picture : {"projection_camera0.png", "odd_even_camera0.png",
                              "residuals_by_place.png", "residuals_by_photo_camera0.png"}) {
    EXPECT_TRUE(fs::exists(capture / "glint/calib" / picture)) << picture;
  }
  EXPECT_THAT(ReadText(capture / "glint/calib/residuals.json"), HasSubstr("row_motion_share"));
}

TEST_F(CalibProgram, ExportsAColmapModelWhoseCornersLieWhereTheyWereSeen) {
  const fs::path capture = Copy("exported", true);
  // Nothing is computed anew for it.
  EXPECT_THAT(Calibrate(capture, "--export colmap").output, HasSubstr("up to date"));
  const ColmapModel model = ReadColmapModel(capture / "glint/colmap");
  ASSERT_EQ(model.images.size(), 6u);
  ASSERT_EQ(model.cameras.size(), 1u);
  EXPECT_GT(model.points.size(), 20u);
  size_t seen = 0;
  for (const ColmapPoint& point : model.points) {
    EXPECT_EQ(point.position.z(), 0);
    for (const ColmapTrackElement& element : point.track) {
      const ColmapImage& image = model.images[element.image_id - 1];
      EXPECT_EQ(image.name, "photos/p" + std::to_string(element.image_id - 1) + ".png");
      const ColmapObservation& observation = image.observations[element.observation];
      EXPECT_EQ(observation.point_id, point.id);
      const Eigen::Vector3d in_camera = image.camera_from_model() * point.position;
      const Eigen::Vector2d predicted =
          ColmapImagePoint(model.cameras[0].model, model.cameras[0].parameters,
                           in_camera.x() / in_camera.z(), in_camera.y() / in_camera.z());
      EXPECT_LT((predicted - observation.point_px).norm(), 0.6);
      ++seen;
    }
  }
  EXPECT_GT(seen, 100u);
}

TEST_F(CalibProgram, NamesPhotosWithoutTheBoard) {
  const fs::path capture = Copy("noboard", true);
  const GrayImage gray{640, 480, std::vector<unsigned char>(640 * 480, 120)};
  for (int i = 1; i < 6; ++i)
    testing::WritePhoto(capture / "photos" / ("p" + std::to_string(i) + ".png"), gray);
  ExpectUserError(capture, {"capture.toml", "photos: found the board in only one of the 6",
                            "photos/p0.png", "photos/p3.png", "at least two are needed"});
  testing::WritePhoto(capture / "photos/p0.png", gray);
  ExpectUserError(capture, {"found the board in none of the 6 photographs", "photos/p0.png"});
}

TEST_F(CalibProgram, LeavesOutAPhotoWithoutTheBoardAndSaysSo) {
  const fs::path capture = Copy("onewithout");
  testing::WritePhoto(capture / "photos/p2.png",
                      {640, 480, std::vector<unsigned char>(640 * 480, 120)});
  const Result result = Calibrate(capture);
  EXPECT_EQ(result.code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("left out: photos/p2.png"));
  EXPECT_EQ(ReadCalibration(capture / "glint/calib/manifest.json").photos.size(), 5u);
}

TEST_F(CalibProgram, OnePhotographTakesItsFocalLengthFromElsewhereAndSaysSo) {
  const fs::path capture = Copy("one");
  for (int i = 1; i < 6; ++i) fs::remove(capture / "photos" / ("p" + std::to_string(i) + ".png"));
  const Result result = Calibrate(capture);
  EXPECT_EQ(result.code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("one photograph does not determine the focal length"));
  EXPECT_THAT(result.output, HasSubstr("26 mm equivalent"));
  const Calibration calibration = ReadCalibration(capture / "glint/calib/manifest.json");
  ASSERT_EQ(calibration.photos.size(), 1u);
  const double diagonal_px = std::hypot(640, 480);
  EXPECT_NEAR(calibration.cameras[0].focal_length_x(), 26 / std::hypot(36, 24) * diagonal_px, 1e-3);
  // Distortion that the assumed lens lacks is not the board's.
  const Json diagnosis = ReadManifest(capture / "glint/calib/manifest.json").metrics["diagnosis"];
  if (diagnosis.contains("board_bend")) {
    EXPECT_EQ(diagnosis["board_bend"]["solved_for"], false);
  }
}

TEST_F(CalibProgram, OnePhotographWithoutABoardIsTakenFromStraightAbove) {
  const fs::path capture = Copy("above");
  for (int i = 1; i < 6; ++i) fs::remove(capture / "photos" / ("p" + std::to_string(i) + ".png"));
  const auto with = [&](const std::string& poses) {
    WriteText(capture / "capture.toml",
              "[sample]\nsize_mm = [40, 40]\n[photos]\nfiles = [\"photos/*.png\"]\n"
              "[calib]\nposes = \"above\"\n" +
                  poses);
  };
  with("");
  ExpectUserError(capture, {"poses: found no length", "picture_width_mm"});
  with("[poses]\npicture_width_mm = 30\n");
  ExpectUserError(capture, {"sample.size_mm: found 40 x 40 mm", "shows 30 x 22.5 mm"});
  with("[poses]\npicture_width_mm = 128\n");
  const Result result = Calibrate(capture);
  EXPECT_EQ(result.code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("straight above, 128 mm across"));
  const Calibration calibration = ReadCalibration(capture / "glint/calib/manifest.json");
  ASSERT_EQ(calibration.photos.size(), 1u);
  // 64 mm right of the middle is the picture's right border; up is up.
  const Eigen::Vector2d right =
      ImageFromCamera(calibration.cameras[0],
                      calibration.photos[0].camera_from_sample * Eigen::Vector3d(64, 12.8, 0));
  EXPECT_NEAR(right.x(), 640, 1e-6);
  EXPECT_NEAR(right.y(), 240 - 64, 1e-6);
  fs::copy_file(capture / "photos/p0.png", capture / "photos/p1.png");
  ExpectUserError(capture, {"photos.files: found 2 photographs", "is for one photograph"});
}

TEST_F(CalibProgram, SaysThatTheBoardIsAnother) {
  const fs::path capture = Copy("otherboard", true);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = kCaptureToml;
    text.replace(text.find(from), from.size(), to);
    WriteText(capture / "capture.toml", text);
  };
  with("[8, 6]", "[6, 8]");
  ExpectUserError(capture,
                  {"board: found a board that does not fit", "8 x 6 squares, not of 6 x 8"});
  with("[8, 6]", "[5, 4]");
  ExpectUserError(capture, {"ids up to 23"});
  with("marker_mm = 12", "marker_mm = 16");
  ExpectUserError(capture, {"correct marker_mm"});
  with("DICT_5X5_100", "DICT_6X6_250");
  ExpectUserError(capture, {"found the board in none", "markers of DICT_5X5"});
}

TEST_F(CalibProgram, LeavesOutAPhotoOfAnotherSizeAndSaysSo) {
  const fs::path capture = Copy("othersize");
  GrayImage small = TakePhoto(3);
  int factor = 1;
  small = Reduced(small, 320, &factor);
  testing::WritePhoto(capture / "photos/p3.png", small);
  const Result result = Calibrate(capture);
  EXPECT_EQ(result.code, 0) << result.output.substr(0, 500);
  EXPECT_THAT(result.output,
              HasSubstr("photos/p3.png is left out: it has 320x240 pixels, while 5"));
  EXPECT_EQ(result.output.find("camera 1: OPENCV"), std::string::npos);
  EXPECT_EQ(ReadCalibration(capture / "glint/calib/manifest.json").photos.size(), 5u);
}

TEST_F(CalibProgram, RefusesPhotosThatAllLookStraightDown) {
  const fs::path capture = Copy("flat", true);
  for (int i = 0; i < 6; ++i) {
    testing::WritePhoto(capture / "photos" / ("p" + std::to_string(i) + ".png"), TakePhoto(i, 0));
  }
  ExpectUserError(capture, {"capture.toml", "6 photographs", "tilt the phone"});
  // The intrinsics of the good capture fix that.
  Calibrate(root_ / "good");
  const Result result =
      Calibrate(capture, "--fix-intrinsics " + (root_ / "good/glint/calib/manifest.json").string());
  EXPECT_EQ(result.code, 0) << result.output;
}

TEST_F(CalibProgram, NamesABadPhotoAndMissingTables) {
  const fs::path capture = Copy("badphoto", true);
  WriteText(capture / "photos/p4.png", "this is no picture");
  ExpectUserError(capture, {"photos/p4.png"});
  WriteText(capture / "capture.toml",
            "[sample]\nsize_mm = [40, 40]\n[photos]\nfiles = \"photos/*.png\"\n");
  ExpectUserError(capture, {"capture.toml", "board"});
}

TEST_F(CalibProgram, RefusesUnknownParametersToHold) {
  const fs::path capture = Copy("hold");
  ExpectUserError(capture, {"hold", "k9", "OPENCV"}, "--hold k9");
}

}  // namespace
}  // namespace glint
