// A synthetic dome from photographs to refined maps: the lamps' strengths are found, and what
// cannot be used is told.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <span>
#include <sstream>

#include "base/files/json_file.h"
#include "base/formats/calibration.h"
#include "base/formats/manifest.h"
#include "base/formats/rectified_set.h"
#include "base/formats/svbrdf_file.h"
#include "tests/calib/testing/synthetic_capture.h"

namespace glint {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

constexpr size_t kLights = 20;

class FixedCamera : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<test::TemporaryFolder>();
    MakeDome(*shared_ / "dome", {"--family", "impasto", "--seed", "5", "--texels", "64", "--lights",
                                 std::to_string(kLights), "--uneven", "0.2"});
  }
  static void TearDownTestSuite() { shared_.reset(); }
  static void MakeDome(const fs::path& dome, const std::vector<std::string>& options) {
    std::vector<std::string> command = {testing::Program("glint-synth"), "dome", dome.string()};
    for (const char* option : {"--blur-px", "0"}) command.emplace_back(option);
    command.insert(command.end(), options.begin(), options.end());
    const test::Outcome made = test::RunProgram(command);
    ASSERT_EQ(made.code, 0) << made.err;
    const test::Outcome described =
        test::RunProgram({testing::Program("glint-init"), dome.string(), "--lights",
                          (dome / "dirs.lp").string(), "--width-mm", "100"});
    ASSERT_EQ(described.code, 0) << described.err;
  }

  FixedCamera() : capture_(folder_ / "dome") {
    fs::copy(*shared_ / "dome", capture_, fs::copy_options::recursive);
  }
  test::Outcome Calibrate() const {
    return test::RunProgram({testing::Program("glint-calib"), capture_.string()});
  }
  void Run(const std::vector<std::string>& options) const {
    std::vector<std::string> command = {testing::Program("glint-run"), capture_.string(), "--until",
                                        "refine"};
    command.insert(command.end(), options.begin(), options.end());
    const test::Outcome outcome = test::RunProgram(command);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  Calibration Calibrated() const { return ReadCalibration(capture_ / "glint/calib/manifest.json"); }
  // By view's name, those of refinement.
  std::map<std::string, Json> Corrections() const {
    std::map<std::string, Json> corrections;
    const Manifest refined = ReadManifest(capture_ / "glint/refine/manifest.json");
    for (const Json& entry : refined.data["corrections"]) {
      corrections[entry["name"].get<std::string>()] = entry;
    }
    return corrections;
  }
  std::map<std::string, double> TrueStrengths() const {
    std::map<std::string, double> strengths;
    const Json truth = ReadJsonFile(capture_ / "truth/lights.json", "");
    for (const Json& light : truth["lights"]) {
      strengths[light["photo"].get<std::string>()] = light["strength_rgb"][1].get<double>();
    }
    return strengths;
  }
  void ExpectTheStrengths() const;
  // Lines of dirs.lp, the first of which is their number.
  std::vector<std::string> Lines() const {
    std::istringstream text(test::ReadAll(capture_ / "dirs.lp"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }
  void WriteLines(const std::vector<std::string>& lines) const {
    std::string text = std::to_string(lines.size() - 1) + "\n";
    for (size_t i = 1; i < lines.size(); ++i) text += lines[i] + "\n";
    test::WriteAll(capture_ / "dirs.lp", text);
  }

  static inline std::unique_ptr<test::TemporaryFolder> shared_;
  test::TemporaryFolder folder_;
  fs::path capture_;
};

// "a.png 0.1 0.2 0.9" → "a.png 0.1 0.2 -0.9".
std::string FromBelow(const std::string& line) {
  const size_t z = line.rfind(' ') + 1;
  return line.substr(0, z) + "-" + line.substr(z);
}

double MeanDiffuse(const SvbrdfMaps& maps) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    for (const float value : maps.plane(kDiffuseR + c)) sum += value;
  }
  return sum;
}

// Of angles between normals, degrees.
double RootMeanSquareAngle_deg(const SvbrdfMaps& a, const SvbrdfMaps& b) {
  double squares = 0;
  for (size_t t = 0; t < a.texels(); ++t) {
    double cosine = 0;
    for (const int n : {kNormalX, kNormalY, kNormalZ}) {
      cosine += static_cast<double>(a.plane(n)[t]) * b.plane(n)[t];
    }
    squares += std::pow(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi, 2);
  }
  return std::sqrt(squares / static_cast<double>(a.texels()));
}

double RootMeanSquareDifference(std::span<const float> a, std::span<const float> b) {
  double squares = 0;
  for (size_t i = 0; i < a.size(); ++i) squares += std::pow(a[i] - b[i], 2);
  return std::sqrt(squares / static_cast<double>(a.size()));
}

double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double mean_a = 0, mean_b = 0, aa = 0, ab = 0, bb = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / static_cast<double>(a.size());
    mean_b += b[i] / static_cast<double>(b.size());
  }
  for (size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return ab / std::sqrt(aa * bb);
}

// Of calibration times those of refinement.
void FixedCamera::ExpectTheStrengths() const {
  const std::map<std::string, double> truth = TrueStrengths();
  const RectifiedSet set = ReadRectifiedSet(capture_ / "glint/rectify/manifest.json");
  const std::map<std::string, Json> corrections = Corrections();
  ASSERT_EQ(corrections.size(), kLights);
  std::map<std::string, double> calibrated;
  for (const CalibratedPhoto& photo : Calibrated().photos) {
    calibrated[photo.photo] = photo.exposure;
  }
  std::vector<double> found, expected;
  for (const RectifiedView& view : set.views) {
    const double correction = corrections.at(view.name)["exposure"].get<double>();
    found.push_back(std::log(calibrated.at(view.photo) * correction));
    expected.push_back(std::log(truth.at(view.photo)));
  }
  EXPECT_GT(Correlation(found, expected), 0.98);
}

TEST_F(FixedCamera, StrengthsOfLampsAreFoundThoseOfHeldOutPhotographsToo) {
  Run({});
  const RectifiedSet set = ReadRectifiedSet(capture_ / "glint/rectify/manifest.json");
  EXPECT_TRUE(set.fixed_camera);
  EXPECT_FALSE(set.light_power_known);
  EXPECT_EQ(set.views.size(), kLights);
  ExpectTheStrengths();
  for (const auto& [name, correction] : Corrections()) {
    EXPECT_FALSE(correction.contains("held_out")) << name;
  }

  Run({"--exclude", "light_003"});
  ExpectTheStrengths();
  for (const auto& [name, correction] : Corrections()) {
    EXPECT_EQ(correction.value("held_out", false), name == "view_003") << name;
  }
}

// The scale that nothing else tells: how dark the sample is.
TEST_F(FixedCamera, PowerThatIsStatedIsTheMeanLampsAndSetsAlbedos) {
  const Json truth = ReadJsonFile(capture_ / "truth/lights.json", "");
  const double power = truth["power"].get<double>();
  std::string toml = test::ReadAll(capture_ / "capture.toml");
  const size_t at = toml.find("# power = 30000");
  ASSERT_NE(at, std::string::npos);
  toml.replace(at, std::string("# power = 30000").size(), fmt::format("power = {:.6g}", power));
  test::WriteAll(capture_ / "capture.toml", toml);
  Run({});
  const Calibration calibration = Calibrated();
  EXPECT_TRUE(calibration.light_power_known);
  double mean = 0;
  for (const CalibratedPhoto& photo : calibration.photos) {
    mean += std::log(calibration.light_rgb[1] * photo.exposure) / kLights;
  }
  EXPECT_NEAR(mean, std::log(power), 1e-6);
  const SvbrdfMaps found = ReadSvbrdf(capture_ / "glint/refine/svbrdf.exr");
  const SvbrdfMaps expected = ReadSvbrdf(capture_ / "truth/svbrdf.exr");
  EXPECT_NEAR(MeanDiffuse(found) / MeanDiffuse(expected), 1, 0.1);
}

// Between its highlights a metal is as dark as in shadow. Told by darkness alone, shadows left 1.5°
// and .13 of roughness.
TEST_F(FixedCamera, ReliefAndGlossOfAMetalAreFoundDespiteItsShadows) {
  capture_ = folder_ / "metal";
  MakeDome(capture_, {"--family", "hammered", "--seed", "3", "--texels", "96", "--lights", "40",
                      "--shadows", "--uneven", "0.2"});
  Run({});
  const SvbrdfMaps found = ReadSvbrdf(capture_ / "glint/refine/svbrdf.exr");
  const SvbrdfMaps truth = ReadSvbrdf(capture_ / "truth/svbrdf.exr");
  EXPECT_LT(RootMeanSquareAngle_deg(found, truth), 0.5);
  EXPECT_LT(RootMeanSquareDifference(found.plane(kRoughness), truth.plane(kRoughness)), 0.03);
}

TEST_F(FixedCamera, CalibrationTakesTheDirectionsThatAreGiven) {
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Calibration calibration = Calibrated();
  EXPECT_TRUE(calibration.fixed_camera);
  ASSERT_EQ(calibration.photos.size(), kLights);
  const Json truth = ReadJsonFile(capture_ / "truth/lights.json", "")["lights"];
  for (size_t i = 0; i < kLights; ++i) {
    const CalibratedPhoto& photo = calibration.photos[i];
    const Eigen::Vector3d light = Inverse(photo.camera_from_sample) * photo.light_in_camera_mm;
    const Json& direction = truth[i]["direction"];
    const Eigen::Vector3d expected(direction[0].get<double>(), direction[1].get<double>(),
                                   direction[2].get<double>());
    EXPECT_LT((light.normalized() - expected).norm(), 1e-5) << photo.photo;
    EXPECT_GT(photo.exposure, 0);
  }
  EXPECT_EQ(calibration.photos[0].exposure, 1);
}

TEST_F(FixedCamera, PhotographsThatAreNotListedOrLitFromBelowAreLeftOut) {
  std::vector<std::string> lines = Lines();
  lines[2] = FromBelow(lines[2]);
  lines.pop_back();
  WriteLines(lines);
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("light_001.png is left out"), HasSubstr("below"),
                    HasSubstr("light_019.png is left out"), HasSubstr("dirs.lp does not list it")));
  EXPECT_EQ(Calibrated().photos.size(), kLights - 2);
}

TEST_F(FixedCamera, LightsThatAreAllBelowTheHorizonAreRefused) {
  std::vector<std::string> lines = Lines();
  for (size_t i = 1; i < lines.size(); ++i) lines[i] = FromBelow(lines[i]);
  WriteLines(lines);
  const test::Outcome outcome = Calibrate();
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("dirs.lp"), HasSubstr("no usable light"),
                    HasSubstr("below the sample's plane"), HasSubstr("the sign of z")));
}

TEST_F(FixedCamera, PhotographsOfTwoSizesAreRefused) {
  MakeDome(folder_ / "small", {"--seed", "5", "--texels", "32", "--lights", "3"});
  fs::copy_file(folder_ / "small" / "light_001.png", capture_ / "light_007.png",
                fs::copy_options::overwrite_existing);
  const test::Outcome outcome = Calibrate();
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("light_007.png"), HasSubstr("32x32"),
                                 HasSubstr("light_000.png has 64x64")));
}

TEST_F(FixedCamera, PhotographThatIsMissingIsNamed) {
  fs::remove(capture_ / "light_007.png");
  const test::Outcome outcome = Calibrate();
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("dirs.lp"), HasSubstr("1 of 20 names without a photograph"),
                    HasSubstr("light_007.png")));
}

TEST_F(FixedCamera, BallWhoseRimLiesOnALineIsRefused) {
  std::string toml = test::ReadAll(capture_ / "capture.toml");
  const size_t at = toml.find("file = \"dirs.lp\"");
  ASSERT_NE(at, std::string::npos);
  toml.replace(at, toml.find('\n', at) - at, "balls_px = [[1, 1], [5, 5], [20, 20]]");
  test::WriteAll(capture_ / "capture.toml", toml);
  const test::Outcome outcome = Calibrate();
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("lights.balls_px"), HasSubstr("on a line")));
}

}  // namespace
}  // namespace glint
