// glint-calib's verdict on captures with photographs left out on purpose.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "base/formats/manifest.h"
#include "base/images/image.h"
#include "tests/calib/testing/synthetic_photo.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::LookAt;
using ::testing::Not;

const Camera kCamera = testing::SmallCamera();

// Tilt and azimuth of the photographs.
const std::map<std::string, std::pair<double, double>> kPhotos = {
    {"top", {2, 40}},   {"near_top", {12, 90}}, {"near_left", {12, 210}}, {"near_right", {12, 330}},
    {"side0", {30, 0}}, {"side1", {32, 120}},   {"side2", {28, 240}}};

void TakePhoto(const fs::path& file, double tilt_deg, double azimuth_deg) {
  testing::PhotoSettings settings;
  settings.samples = 2;
  const GrayImage gray =
      Photograph(testing::SmallBoard(), kCamera, LookAt(240, tilt_deg, azimuth_deg, 5), settings);
  testing::WritePhoto(file, gray);
}

class Guidance : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    for (const auto& [name, direction] : kPhotos) {
      TakePhoto(capture() / "photos" / (name + ".png"), direction.first, direction.second);
    }
  }
  static void TearDownTestSuite() { delete folder_; }
  static fs::path capture() { return folder_->path() / "capture"; }

  // The capture without the photographs named.
  static void LeaveOut(const std::vector<std::string>& names) {
    std::string files;
    for (const auto& [name, direction] : kPhotos) {
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      files += (files.empty() ? "\"photos/" : ", \"photos/") + name + ".png\"";
    }
    test::WriteAll(capture() / "capture.toml",
                   "[sample]\nsize_mm = [100, 100]\nresolution_px = 512\n[photos]\nfiles = [" +
                       files +
                       "]\n[board]\nkind = \"charuco\"\nsquares = [8, 6]\nsquare_mm = 20\n"
                       "marker_mm = 12\ndictionary = \"DICT_5X5_100\"\n");
  }
  static test::Outcome Calib(const std::vector<std::string>& options) {
    std::vector<std::string> words = {GLINT_BIN_DIR "/glint-calib", capture().string()};
    words.insert(words.end(), options.begin(), options.end());
    return test::RunProgram(words);
  }
  // Texts of advice by topic, as --check gives them.
  static std::map<std::string, std::string> Checked() {
    const test::Outcome outcome = Calib({"--check", "--json", "--log-level", "off"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::map<std::string, std::string> advice;
    const Json json = Json::parse(outcome.out, nullptr, false);
    if (!json.is_object()) return advice;
    for (const Json& one : json["guidance"]["advice"]) advice[one["topic"]] = one["text"];
    return advice;
  }
  static test::TemporaryFolder* folder_;
};
test::TemporaryFolder* Guidance::folder_ = nullptr;

TEST_F(Guidance, CheckSaysWhatCalibSaysAndWritesNothing) {
  LeaveOut({});
  const test::Outcome check = Calib({"--check", "--json"});
  ASSERT_EQ(check.code, 0) << check.err;
  EXPECT_FALSE(fs::exists(capture() / "glint"));
  const Json quick = Json::parse(check.out)["guidance"];
  const test::Outcome calib = Calib({});
  ASSERT_EQ(calib.code, 0) << calib.err;
  const Manifest manifest = ReadManifest(capture() / "glint/calib/manifest.json", "calib");
  EXPECT_NO_THROW(VerifyOutputs(capture() / "glint/calib/manifest.json", manifest));
  const Json& whole = manifest.metrics["guidance"];
  EXPECT_EQ(quick["verdict"], whole["verdict"]);
  EXPECT_EQ(quick["top_views"], 1);
  EXPECT_EQ(whole["top_views"], 1);
  EXPECT_NEAR(quick["highlight_share"].get<double>(), whole["highlight_share"].get<double>(), 0.02);
  EXPECT_NEAR(whole["views"][0]["tilt_deg"].get<double>(), 12, 0.3);  // near_left
  EXPECT_NEAR(whole["views"][0]["azimuth_deg"].get<double>(), 210, 1.5);
  EXPECT_NEAR(whole["pixels_per_texel"].get<double>(), 560 / 240.0 * 100 / 512, 0.02);
  EXPECT_THAT(calib.out, HasSubstr("guidance: " + whole["verdict"].get<std::string>()));
  for (const char* name : {"guidance_views.svg", "guidance_coverage.png"}) {
    EXPECT_TRUE(std::any_of(manifest.outputs.begin(), manifest.outputs.end(),
                            [&](const ManifestOutput& output) { return output.path == name; }));
  }
}

// A window of 40 mm for a sample of 100.
TEST_F(Guidance, NamesTheSquaresThatTheSampleReachesOver) {
  LeaveOut({});
  EXPECT_EQ(Checked().count("over_board"), 0u);  // on a whole board
  const std::string whole = test::ReadAll(capture() / "capture.toml");
  test::WriteAll(capture() / "capture.toml", whole + "window = [3, 2, 2, 2]\n");
  EXPECT_THAT(Checked()["over_board"],
              HasSubstr("30 mm on the left: 2 squares, 30 mm on the right: 2 squares"));
}

TEST_F(Guidance, MissesTheTopView) {
  LeaveOut({});
  EXPECT_EQ(Checked().count("top"), 0u);
  LeaveOut({"top"});
  EXPECT_THAT(Checked()["top"],
              HasSubstr("no photograph within 10° of vertical (the nearest is 12"));
}

TEST_F(Guidance, MissesTheTiltedSide) {
  LeaveOut({});
  EXPECT_EQ(Checked().count("sides"), 0u);
  LeaveOut({"side1"});
  EXPECT_THAT(Checked()["sides"], HasSubstr("no tilted photograph from the top left"));
}

TEST_F(Guidance, MissesTheHighlightAtTheTop) {
  LeaveOut({"top", "near_top"});
  EXPECT_THAT(Checked()["highlight"], HasSubstr("never shows a highlight"));
  EXPECT_THAT(Checked()["highlight"], HasSubstr("toward the top"));
}

TEST_F(Guidance, JudgesOnePhotographThatDoesNotTellItsFocalLength) {
  LeaveOut({"near_top", "near_left", "near_right", "side0", "side1", "side2"});
  const test::Outcome outcome = Calib({});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("one photograph does not determine the focal length"));
  const auto advice = Checked();
  EXPECT_THAT(advice.at("focal"), HasSubstr("cannot be determined"));
  EXPECT_THAT(advice.at("tilted"), HasSubstr("look straight down"));
  EXPECT_THAT(advice.at("few"), HasSubstr("4 more photographs"));
}

TEST_F(Guidance, ACheckIsNoPropertyOfACapture) {
  LeaveOut({});
  const std::string toml = test::ReadAll(capture() / "capture.toml");
  test::WriteAll(capture() / "capture.toml", toml + "[calib]\ncheck = true\n");
  const test::Outcome outcome = Calib({});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("calib.check"));
  EXPECT_THAT(outcome.err, HasSubstr("--check"));
}

TEST_F(Guidance, NamesBadInputAsCalibDoes) {
  test::WriteAll(capture() / "capture.toml",
                 "[sample]\nsize_mm = [100, 100]\n[photos]\nfiles = \"photos/*.png\"\n");
  const test::Outcome outcome = Calib({"--check"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("board"));
}

}  // namespace
}  // namespace glint
