// Captures whose camera sees colours as it likes, and whose chart says how.
#include <OpenImageIO/imagebuf.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <functional>

#include "base/formats/calibration.h"
#include "base/formats/manifest.h"
#include "base/formats/rectified_set.h"
#include "base/formats/svbrdf_file.h"
#include "base/reflectance/svbrdf_maps.h"
#include "calib/chart/cielab.h"
#include "calib/chart/delta_e.h"
#include "tests/calib/chart/chart_scene.h"
#include "tests/calib/testing/synthetic_capture.h"
#include "tests/support/data_folder.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kTexels = 96;
constexpr float kGamma = 2.2f;

// Rough squares in the colours of a Classic chart.
SvbrdfMaps Squares() {
  const Chart chart = *ChartOfKind("classic24");
  SvbrdfMaps maps(kTexels, kTexels);
  for (size_t i = 0; i < maps.texels(); ++i) {
    const size_t column = 6 * (i % kTexels) / kTexels, row = 4 * (i / kTexels) / kTexels;
    const Eigen::Vector3d rgb =
        Rec709FromLab(chart.patches[6 * row + column].lab).cwiseMax(0.02).cwiseMin(0.9);
    maps.plane(kNormalZ)[i] = 1;
    for (int c = 0; c < 3; ++c) {
      maps.plane(kDiffuseR + c)[i] = static_cast<float>(rgb[c]);
      maps.plane(kSpecularR + c)[i] = 0.04f;
    }
    maps.plane(kRoughness)[i] = 0.8f;
  }
  return maps;
}

// Linear values of Rec.709 ones, white-balanced but for a cast; no channel passes 1.
Eigen::Matrix3d CameraOfTheTest() {
  return testing::CameraFromRec709(testing::CameraMatrices()[2].matrix,
                                   testing::FlashWhites()[1].xyz);
}

class ChartCapture : public testing::SyntheticCapture {
 protected:
  static void SetUpTestSuite() {
    maps_ = std::make_unique<test::TemporaryFolder>();
    const fs::path file = maps_->path() / "svbrdf.exr";
    WriteSvbrdf(file, Squares(), ReflectanceConvention::Photograph());
    Make({"--megapixels", "1", "--photos", "5", "--resolution", std::to_string(kTexels), "--maps",
          file.string(), "--seed", "3", "--jpeg-quality", "98"});
  }
  static void TearDownTestSuite() {
    maps_.reset();
    testing::SyntheticCapture::TearDownTestSuite();
  }

  ChartCapture() {
    std::string toml = test::ReadAll(capture_ / "capture.toml");
    const size_t at = toml.find("encoding");
    toml.replace(at, toml.find('\n', at) - at, "encoding = \"gamma2.2\"");
    test::WriteAll(capture_ / "capture.toml", toml);
  }

  void AddToToml(const std::string& text) const {
    const fs::path file = capture_ / "capture.toml";
    test::WriteAll(file, test::ReadAll(file) + text);
  }

  // Changes the linear pixels of every photograph; name, EXIF and encoding stay.
  void Change(const std::function<void(const std::string& name, Image* linear)>& change) const {
    for (const auto& entry : fs::directory_iterator(capture_ / "photos")) {
      const std::string file = entry.path().string();
      OIIO::ImageBuf photo(file);
      OIIO::ImageSpec spec = photo.spec();
      Image image(spec.width, spec.height, kRgbChannels);
      std::vector<float> pixels(3 * image.pixels());
      ASSERT_TRUE(photo.get_pixels(OIIO::ROI(), OIIO::TypeDesc::FLOAT, pixels.data()));
      for (size_t i = 0; i < pixels.size(); ++i) {
        image.channel(static_cast<int>(i % 3))[i / 3] = std::pow(pixels[i], kGamma);
      }
      change(entry.path().filename(), &image);
      for (size_t i = 0; i < pixels.size(); ++i) {
        const float linear = image.channel(static_cast<int>(i % 3))[i / 3];
        pixels[i] = std::pow(std::clamp(linear, 0.0f, 1.0f), 1 / kGamma);
      }
      spec.attribute("Compression", "jpeg:98");
      OIIO::ImageBuf changed(spec);
      ASSERT_TRUE(changed.set_pixels(OIIO::ROI(), OIIO::TypeDesc::FLOAT, pixels.data()));
      ASSERT_TRUE(changed.write(file)) << changed.geterror();
    }
  }

  // As another camera would have taken them.
  void SeeWith(const Eigen::Matrix3d& camera) const {
    Change([&](const std::string&, Image* image) {
      for (size_t i = 0; i < image->pixels(); ++i) {
        Eigen::Vector3d rgb;
        for (int c = 0; c < 3; ++c) rgb[c] = image->channel(c)[i];
        rgb = camera * rgb;
        for (int c = 0; c < 3; ++c) image->channel(c)[i] = static_cast<float>(rgb[c]);
      }
    });
  }

  // In the first photograph a chart lies on the sample.
  void LayChartOnSample() const {
    Change([](const std::string& name, Image* image) {
      if (name != "photo_000.jpg") return;
      testing::ChartShot shot;
      shot.width = image->width;
      shot.height = image->height;
      const double x = image->width / 2.0, y = image->height / 2.0;
      shot.corners_px = {
          {{x - 120, y - 75}, {x + 120, y - 80}, {x + 118, y + 78}, {x - 122, y + 76}}};
      shot.bits = 32;
      shot.white = 0.7;
      const Image chart = testing::PhotographOf(*ChartOfKind("classic24"), shot).image.Planes();
      for (int row = static_cast<int>(y) - 95; row < y + 95; ++row) {
        for (int column = static_cast<int>(x) - 140; column < x + 140; ++column) {
          const size_t at = static_cast<size_t>(row) * image->width + column;
          for (int c = 0; c < 3; ++c) image->channel(c)[at] = chart.channel(c)[at];
        }
      }
    });
  }

  void PhotographChart(const Eigen::Matrix3d& camera) const {
    fs::create_directories(capture_ / "chart");
    testing::ChartShot shot;
    shot.camera = camera;
    WritePng(capture_ / "chart/chart.png",
             testing::PhotographOf(*ChartOfKind("classic24"), shot).image.Planes());
  }

  test::Outcome Calibrate(const std::vector<std::string>& options = {}) const {
    std::vector<std::string> command = {testing::Program("glint-calib"), capture_.string()};
    command.insert(command.end(), options.begin(), options.end());
    return test::RunProgram(command);
  }

  // Colours of the first view's texels under its light, on a scale of their own.
  std::vector<Eigen::Vector3d> Rectified() const {
    const test::Outcome calib = Calibrate();
    EXPECT_EQ(calib.code, 0) << calib.err;
    const test::Outcome rectify =
        test::RunProgram({testing::Program("glint-rectify"), capture_.string()});
    EXPECT_EQ(rectify.code, 0) << rectify.err;
    const RectifiedSet set = ReadRectifiedSet(capture_ / "glint/rectify/manifest.json");
    const RectifiedImage image = ReadRectifiedImage(set, set.views.at(0));
    std::vector<Eigen::Vector3d> colours;
    const size_t texels = image.mask.size();
    for (size_t i = 0; i < texels; ++i) {
      Eigen::Vector3d colour = Eigen::Vector3d::Zero();
      for (int c = 0; c < 3; ++c) {
        colour[c] = image.rgb[c * texels + i] / set.views[0].view.light_rgb[c];
      }
      colours.push_back(image.mask[i] > 0 ? colour : Eigen::Vector3d::Zero());
    }
    return colours;
  }

  static double MeanDeltaE(std::vector<Eigen::Vector3d> colours,
                           std::vector<Eigen::Vector3d> reference) {
    // Powers differ by what the luminance of a colour is to the camera: one scale each.
    for (auto* all : {&colours, &reference}) {
      double green = 0;
      for (const Eigen::Vector3d& colour : *all) green += colour.y();
      for (Eigen::Vector3d& colour : *all) {
        colour *= 0.25 * static_cast<double>(all->size()) / green;
      }
    }
    double sum = 0;
    int count = 0;
    for (size_t i = 0; i < colours.size(); ++i) {
      if (colours[i].y() <= 0 || reference[i].y() <= 0) continue;
      sum += DeltaE00(LabFromRec709(colours[i]), LabFromRec709(reference[i]));
      ++count;
    }
    EXPECT_GT(count, kTexels * kTexels / 2);
    return sum / count;
  }

  Manifest Result() const { return ReadManifest(capture_ / "glint/calib/manifest.json"); }

  static std::unique_ptr<test::TemporaryFolder> maps_;
};

std::unique_ptr<test::TemporaryFolder> ChartCapture::maps_;

TEST_F(ChartCapture, ComesBackInTheColoursOfACameraThatSeesRec709) {
  const auto reference = Rectified();
  SeeWith(CameraOfTheTest());
  const double uncorrected = MeanDeltaE(Rectified(), reference);
  PhotographChart(CameraOfTheTest());
  AddToToml("\n[chart]\nphoto = \"chart/chart.png\"\n");
  const double corrected = MeanDeltaE(Rectified(), reference);
  std::printf("rectified colours: %.2f without the chart, %.2f with it\n", uncorrected, corrected);
  EXPECT_GT(uncorrected, 4);
  EXPECT_LT(corrected, 1.5);
  const Json chart = Result().metrics["chart"];
  EXPECT_TRUE(chart["found"].get<bool>());
  EXPECT_EQ(chart["patches"], 24);
  EXPECT_LT(chart["delta_e_held_out_mean"].get<double>(), 1.5);
  EXPECT_EQ(chart["white_from"], "chart");
  EXPECT_TRUE(fs::exists(capture_ / "glint/calib/chart.png"));
  // The flash is white in corrected views.
  const RectifiedSet set = ReadRectifiedSet(capture_ / "glint/rectify/manifest.json");
  EXPECT_EQ(set.views[0].view.light_rgb[0], set.views[0].view.light_rgb[2]);
}

TEST_F(ChartCapture, TakesThePapersWhiteWhereTheChartWasBalancedOtherwise) {
  const auto reference = Rectified();
  SeeWith(CameraOfTheTest());
  const Eigen::Vector3d another_balance(0.7, 1, 0.85);
  PhotographChart(another_balance.asDiagonal() * CameraOfTheTest());
  AddToToml("\n[chart]\nphoto = \"chart/chart.png\"\n");
  EXPECT_LT(MeanDeltaE(Rectified(), reference), 1.5);
  EXPECT_EQ(Result().metrics["chart"]["white_from"], "paper");
  EXPECT_THAT(Result().metrics["chart"]["findings"].dump(), HasSubstr("automatic white balance"));
}

TEST_F(ChartCapture, MayHaveTheChartsPhotographAmongTheOthers) {
  PhotographChart(CameraOfTheTest());
  fs::rename(capture_ / "chart/chart.png", capture_ / "photos/chart.png");
  std::string toml = test::ReadAll(capture_ / "capture.toml");
  const size_t at = toml.find("files");
  toml.replace(at, toml.find('\n', at) - at, "files = [\"photos/*\"]");
  test::WriteAll(capture_ / "capture.toml", toml + "\n[chart]\nphoto = \"photos/chart.png\"\n");
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err + outcome.out, Not(HasSubstr("chart.png is left out")));
  EXPECT_EQ(Result().data["photos"].size(), 5u);
  EXPECT_TRUE(Result().data.contains("colour_correction"));
}

TEST_F(ChartCapture, MayHaveTheChartInAFlashPhotograph) {
  LayChartOnSample();
  SeeWith(CameraOfTheTest());
  AddToToml("\n[chart]\nphoto = \"photos/photo_000.jpg\"\n");
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Result().data["photos"].size(), 5u);
  const Json chart = Result().metrics["chart"];
  EXPECT_EQ(chart["patches"], 24);
  EXPECT_LT(chart["delta_e_held_out_mean"].get<double>(), 1.5);
  EXPECT_LT(chart["delta_e_held_out_worst"].get<double>(), 4);
}

TEST_F(ChartCapture, IsCheckedBeforeTheSampleIsPutAway) {
  PhotographChart(CameraOfTheTest());
  AddToToml("\n[chart]\nphoto = \"chart/chart.png\"\n");
  const test::Outcome outcome = Calibrate({"--check"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("24 of 24 patches of classic24"));
}

TEST_F(ChartCapture, SaysWhatIsWrongWithTheChart) {
  PhotographChart(CameraOfTheTest());
  const std::string before = test::ReadAll(capture_ / "capture.toml");
  const auto with = [&](const std::string& chart) {
    test::WriteAll(capture_ / "capture.toml", before + "\n[chart]\n" + chart);
    return Calibrate();
  };
  test::Outcome outcome = with("photo = \"chart/chart.png\"\nkind = \"sg140\"\n");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("chart.png"), HasSubstr("no sg140 chart"), HasSubstr("corners_px")));
  // Corners from the wrong end.
  outcome = with(
      "photo = \"chart/chart.png\"\ncorners_px = [[985, 745], [165, 700], [190, 150], [1020, "
      "190]]\n");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("top left is at (190, 150)"));
  EXPECT_LT(Result().metrics["chart"]["delta_e_held_out_mean"].get<double>(), 1.5);
  // Corners of something else.
  outcome = with(
      "photo = \"chart/chart.png\"\ncorners_px = [[300, 200], [700, 230], [690, 500], [310, "
      "480]]\n");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("chart.png"), HasSubstr("held-out patches"),
                                 HasSubstr("kind and corners_px")));
}

// The only real card among the data: a phone's flash, 18 % grey, no chart.
TEST_F(ChartCapture, TakesTheCastOfARealPhoneFromItsGreyCard) {
  const fs::path card = test::DataFolder() / "captures/towel-flash-ambient/photos/greycard_low.jpg";
  if (!fs::exists(card)) GTEST_SKIP() << card;
  fs::create_directories(capture_ / "chart");
  fs::copy_file(card, capture_ / "chart/grey.jpg");
  AddToToml(
      "\n[chart]\nphoto = \"chart/grey.jpg\"\nkind = \"grey\"\ncorners_px = [[250, 150], [550, "
      "150], [550, 450], [250, 450]]\n");
  const test::Outcome outcome = Calibrate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json chart = Result().metrics["chart"];
  std::printf("%s: white %s, %.2f dE00 from neutral\n", card.filename().c_str(),
              chart["white_rgb"].dump().c_str(), chart["delta_e_uncorrected_mean"].get<double>());
  const auto white = chart["white_rgb"].get<std::vector<double>>();
  // Greenish, and no more than a phone's balance is off.
  EXPECT_LT(white[0] / white[1], 1);
  EXPECT_LT(white[2] / white[1], 1);
  EXPECT_GT(chart["delta_e_uncorrected_mean"].get<double>(), 1);
  EXPECT_LT(chart["delta_e_uncorrected_mean"].get<double>(), 10);
  // The synthetic board's paper is neutral, and the card counts all the same.
  EXPECT_EQ(chart["white_from"], "chart");
  EXPECT_THAT(chart["findings"].dump(), HasSubstr("differs from the board's paper by 12 %"));
}

}  // namespace
}  // namespace glint
