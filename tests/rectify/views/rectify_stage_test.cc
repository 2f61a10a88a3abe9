// glint-rectify on small captures, run as a person runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "base/files/files.h"
#include "base/formats/calibration.h"
#include "base/formats/rectified_set.h"
#include "base/linearize/encoding.h"
#include "base/programs/stage.h"
#include "tests/rectify/plane_photo.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr int kSide_px = 200;
constexpr double kSample_mm = 40;

double Pattern(double x_mm, double y_mm) {
  return 0.4 + 0.2 * std::sin(x_mm / 4) + 0.15 * std::cos(y_mm / 3 + x_mm / 9);
}

class RectifyStage : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("glint_rectify_" + std::to_string(getpid()) + "_" + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "photos");
    WriteFileAtomically(folder_ / "capture.toml",
                        "[sample]\nsize_mm = [40, 40]\nresolution_px = 64\n"
                        "[photos]\nfiles = [\"photos/*.png\"]\n");
    for (int i = 0; i < 3; ++i) {
      poses_.push_back(LookAtSample(100, 20.0 * i - 20, 30.0 * i));
      TakePhoto(i);
    }
    Calibrate();
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path PhotoFile(int i) const { return folder_ / ("photos/p" + std::to_string(i) + ".png"); }
  fs::path Views() const { return folder_ / "glint" / "rectify"; }
  Camera camera() const { return TestCamera(kSide_px, 250, -0.1, 0.02); }

  void TakePhoto(int i) {
    Image image =
        PhotographPlane(camera(), poses_[static_cast<size_t>(i)], Pattern, 1).image.Planes();
    for (float& value : image.samples) value = EncodedFromLinear(Encoding::kGamma22, value);
    WritePng(PhotoFile(i), image, 16);
  }

  // Writes what glint-calib would.
  void Calibrate(bool light_known = false) {
    Calibration calibration;
    calibration.cameras = {camera()};
    calibration.light_power_known = light_known;
    if (light_known) calibration.light_sd_mm = 0.5;
    calibration.light_rgb = {7, 8, 9};
    std::vector<fs::path> inputs;
    for (int i = 0; i < 3; ++i) {
      CalibratedPhoto photo;
      photo.photo = "photos/p" + std::to_string(i) + ".png";
      photo.camera_from_sample = poses_[static_cast<size_t>(i)];
      photo.light_in_camera_mm = {5, 0, 0};
      if (light_known) photo.blur_px = 0.8 + 0.1 * i;
      calibration.photos.push_back(photo);
      inputs.push_back(PhotoFile(i));
    }
    CommonOptions common;
    common.threads = 1;
    Stage stage(folder_ / "glint" / "calib", {"calib", 1}, OptionSet(), common, inputs, true);
    stage.Commit(ToJson(calibration), Json::object());
  }

  // Exit code; stdout and stderr in output_.
  int Run(const std::string& arguments = "") {
    const fs::path log = folder_ / "log.txt";
    const std::string command = std::string(GLINT_BIN_DIR) + "/glint-rectify " + folder_.string() +
                                " " + arguments + " > " + log.string() + " 2>&1";
    const int status = std::system(command.c_str());
    output_ = ReadTextFile(log);
    return WEXITSTATUS(status);
  }

  std::string Bytes(const std::string& name) const {
    std::ifstream stream(Views() / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  fs::path folder_;
  std::vector<Rigid3> poses_;
  std::string output_;
};

TEST_F(RectifyStage, ViewsShowThePlaneAsItWasPainted) {
  ASSERT_EQ(Run(), 0) << output_;
  const RectifiedSet set = ReadRectifiedSet(Views() / "manifest.json");
  ASSERT_EQ(set.views.size(), 3u);
  EXPECT_EQ(set.convention, ReflectanceConvention::Photograph());
  EXPECT_FALSE(set.light_power_known);
  EXPECT_FALSE(set.light_sd_mm.has_value());
  EXPECT_FALSE(set.views[0].blur_px.has_value());
  for (size_t v = 0; v < 3; ++v) {
    EXPECT_EQ(set.views[v].photo, "photos/p" + std::to_string(v) + ".png");
    EXPECT_TRUE(set.views[v].ldr);
    const RectifiedImage image = ReadRectifiedImage(set, set.views[v]);
    double worst = 0;
    for (int row = 0; row < 64; ++row) {
      for (int column = 0; column < 64; ++column) {
        const size_t texel = static_cast<size_t>(row) * 64 + column;
        ASSERT_EQ(image.mask[texel], 1);
        const double truth = Pattern(set.plane.x_mm(column), set.plane.y_mm(row));
        worst = std::max(worst, std::abs(image.rgb[texel] - truth));
      }
    }
    EXPECT_LT(worst, 0.004);
    const Eigen::Vector3d camera = Inverse(poses_[v]).translation;
    EXPECT_NEAR(set.views[v].view.camera_in_sample_mm[1], camera.y(), 1e-9);
    EXPECT_EQ(set.views[v].view.exposure, 1);
    // The guess, and not calib's placeholder.
    EXPECT_GT(set.views[v].view.light_rgb[0], 1000);
    EXPECT_EQ(set.views[v].view.light_rgb, set.views[0].view.light_rgb);
  }
}

TEST_F(RectifyStage, KeepsAKnownLight) {
  Calibrate(true);
  ASSERT_EQ(Run(), 0) << output_;
  const RectifiedSet set = ReadRectifiedSet(Views() / "manifest.json");
  EXPECT_TRUE(set.light_power_known);
  EXPECT_EQ(set.light_sd_mm, 0.5);
  for (size_t v = 0; v < 3; ++v)
    EXPECT_NEAR(*set.views[v].blur_px, 0.8 + 0.1 * static_cast<double>(v), 1e-12);
  EXPECT_EQ(set.views[1].view.light_rgb, (Vec3d{7, 8, 9}));
}

TEST_F(RectifyStage, SameBytesForAnyNumberOfThreads) {
  ASSERT_EQ(Run("--threads 1"), 0) << output_;
  std::vector<std::string> first;
  const std::vector<std::string> names = {"manifest.json", "view_000.exr", "view_002.exr"};
  first.reserve(names.size());
  for (const std::string& name : names) first.push_back(Bytes(name));
  ASSERT_EQ(Run("--threads 3 --force"), 0) << output_;
  for (size_t i = 0; i < names.size(); ++i) EXPECT_EQ(first[i], Bytes(names[i])) << names[i];
}

TEST_F(RectifyStage, RunsAgainOnlyWhenSomethingItReadsChanged) {
  ASSERT_EQ(Run(), 0) << output_;
  ASSERT_EQ(Run(), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("up to date"));
  std::ofstream(folder_ / "capture.toml", std::ios::app) << "[refine]\n";
  ASSERT_EQ(Run(), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("up to date"));
  std::ofstream(folder_ / "capture.toml", std::ios::app) << "[radiometry]\nencoding = \"srgb\"\n";
  ASSERT_EQ(Run(), 0) << output_;
  EXPECT_THAT(output_, Not(HasSubstr("up to date")));
  ASSERT_EQ(Run("--resolution 32"), 0) << output_;
  EXPECT_EQ(ReadRectifiedSet(Views() / "manifest.json").plane.width, 32);
}

TEST_F(RectifyStage, BadInputIsNamedAndTheOldResultStays) {
  ASSERT_EQ(Run(), 0) << output_;
  const std::string before = Bytes("manifest.json"), view = Bytes("view_001.exr");
  const std::string photo = ReadTextFile(PhotoFile(1));
  const auto expect = [&](const testing::Matcher<std::string>& message) {
    EXPECT_EQ(Run("--force"), 2);
    EXPECT_THAT(output_, message);
    EXPECT_EQ(Bytes("manifest.json"), before);
    EXPECT_EQ(Bytes("view_001.exr"), view);
  };
  // Changed since calib.
  poses_[1] = LookAtSample(101, 0, 0);
  TakePhoto(1);
  expect(AllOf(HasSubstr("photos/p1.png"), HasSubstr("contents other than those"),
               HasSubstr("calib")));
  // Another size.
  WritePng(PhotoFile(1), Image(64, 48, {"R", "G", "B"}), 8);
  expect(AllOf(HasSubstr("photos/p1.png"), HasSubstr("64x48"), HasSubstr("200x200")));
  // Text.
  WriteFileAtomically(PhotoFile(1), "this is no photograph");
  expect(AllOf(HasSubstr("photos/p1.png"), HasSubstr("no image")));
  // 1×1.
  WritePng(PhotoFile(1), Image(1, 1, {"R", "G", "B"}), 8);
  expect(AllOf(HasSubstr("photos/p1.png"), HasSubstr("1x1")));
  // Truncated, and known to calib in that state.
  WriteFileAtomically(PhotoFile(1), photo.substr(0, photo.size() / 2));
  Calibrate();
  expect(AllOf(HasSubstr("photos/p1.png"), HasSubstr("ends early")));
}

TEST_F(RectifyStage, SaturatedBlackAndAbsentSamplesAreNamed) {
  Image white(kSide_px, kSide_px, {"R", "G", "B"});
  WritePng(PhotoFile(2), white, 8);
  Calibrate();
  EXPECT_EQ(Run(), 2);
  EXPECT_THAT(output_, AllOf(HasSubstr("photos/p2.png"), HasSubstr("black")));
  std::fill(white.samples.begin(), white.samples.end(), 1.0f);
  WritePng(PhotoFile(2), white, 8);
  Calibrate();
  EXPECT_EQ(Run(), 2);
  EXPECT_THAT(output_, AllOf(HasSubstr("photos/p2.png"), HasSubstr("saturated")));
  poses_[2].translation.x() = 500;
  Calibrate();
  EXPECT_EQ(Run(), 2);
  EXPECT_THAT(output_, AllOf(HasSubstr("photos/p2.png"), HasSubstr("outside the photograph")));
  EXPECT_FALSE(fs::exists(Views() / "manifest.json"));
}

TEST_F(RectifyStage, WarnsOfASampleThatIsCutOff) {
  poses_[0].translation.x() = -35;
  TakePhoto(0);
  Calibrate();
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(output_,
              AllOf(HasSubstr("photos/p0.png"), HasSubstr("% of the sample lies outside")));
}

TEST_F(RectifyStage, WrongOptionsAreNamed) {
  std::ofstream(folder_ / "capture.toml", std::ios::app) << "[rectify]\nresolutoin = 5\n";
  EXPECT_EQ(Run(), 2);
  EXPECT_THAT(output_, AllOf(HasSubstr("rectify.resolutoin"), HasSubstr("resolution")));
  EXPECT_EQ(Run("--filter triangle"), 2);
  EXPECT_THAT(output_, HasSubstr("--filter"));
}

TEST_F(RectifyStage, WithoutCalibrationItSaysSo) {
  fs::remove_all(folder_ / "glint" / "calib");
  EXPECT_EQ(Run(), 2);
  EXPECT_THAT(output_, HasSubstr("calib"));
}

}  // namespace
}  // namespace glint
