// Synthetic captures whose photographs are changed as apps, zooms and tone curves change them.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "base/colour/srgb.h"
#include "base/formats/calibration.h"
#include "base/formats/manifest.h"
#include "base/linearize/response_curve.h"
#include "calib/colmap/colmap_model.h"
#include "tests/calib/testing/synthetic_capture.h"

namespace glint {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class BoardLight : public testing::SyntheticCapture {
 protected:
  static void SetUpTestSuite() {
    Make({"--megapixels", "2", "--photos", "6", "--resolution", "128", "--family", "leather",
          "--seed", "3"});
    LetTheEncodingBeFound(Shared());
    truth_ = ReadCalibration(Shared() / "truth/calib/manifest.json");
  }
  static void LetTheEncodingBeFound(const std::filesystem::path& capture) {
    std::string toml = test::ReadAll(capture / "capture.toml");
    const size_t at = toml.find("encoding");
    ASSERT_NE(at, std::string::npos);
    toml.replace(at, toml.find('\n', at) - at, "encoding = \"auto\"");
    test::WriteAll(capture / "capture.toml", toml);
  }
  // The picture changed, its EXIF kept.
  void Change(int photo, const std::function<cv::Mat(const cv::Mat&)>& change) const {
    const std::string file = (capture_ / truth_.photos[photo].photo).string();
    OIIO::ImageBuf before(file);
    OIIO::ImageSpec spec = before.spec();
    cv::Mat pixels(spec.height, spec.width, CV_8UC3);
    ASSERT_TRUE(before.get_pixels(OIIO::ROI(), OIIO::TypeDesc::UINT8, pixels.data));
    const cv::Mat after = change(pixels);
    spec.width = spec.full_width = after.cols;
    spec.height = spec.full_height = after.rows;
    spec.attribute("Compression", "jpeg:97");
    OIIO::ImageBuf changed(spec);
    ASSERT_TRUE(changed.set_pixels(OIIO::ROI(), OIIO::TypeDesc::UINT8, after.data));
    ASSERT_TRUE(changed.write(file)) << changed.geterror();
  }

  test::Outcome Calibrate(const std::string& option = "") const {
    std::vector<std::string> command = {testing::Program("glint-calib"), capture_.string()};
    if (!option.empty()) command.push_back(option);
    test::Outcome outcome = test::RunProgram(command);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome;
  }

  Manifest Result() const { return ReadManifest(capture_ / "glint/calib/manifest.json"); }

  void ExpectTheLight() const {
    const Json light = Result().metrics["light"]["board"];
    const double expected[3] = {10, 0, 0};
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(light["flash_in_camera_mm"]["value"][i].get<double>(), expected[i], 5) << i;
      const double power = light["power_rgb"]["value"][i].get<double>();
      EXPECT_NEAR(power / truth_.light_rgb[static_cast<long>(i)], 1, 0.08) << i;
    }
  }

  static Calibration truth_;
};

Calibration BoardLight::truth_;

// What the picture of a flat board would show, did it arch in the middle along x.
cv::Mat OfBentBoard(const cv::Mat& picture, const Camera& camera, const Rigid3& camera_from_sample,
                    double height_mm, double half_mm) {
  constexpr int kStep_px = 16;  // between them the displacement is linear
  const Rigid3 sample_from_camera = Inverse(camera_from_sample);
  cv::Mat columns((picture.rows + kStep_px - 1) / kStep_px + 1,
                  (picture.cols + kStep_px - 1) / kStep_px + 1, CV_32F);
  cv::Mat rows = columns.clone();
  for (int j = 0; j < columns.rows; ++j) {
    for (int i = 0; i < columns.cols; ++i) {
      const Eigen::Vector2d pixel(kStep_px * i, kStep_px * j);
      const auto ray = NormalizedFromImage(camera, pixel);
      if (!ray) continue;
      const Eigen::Vector3d way = sample_from_camera.rotation * ray->homogeneous();
      const Eigen::Vector3d from = sample_from_camera.translation;
      Eigen::Vector3d at(0, 0, 0);
      for (int round = 0; round < 10; ++round) {
        const double height = height_mm * (1 - at.x() * at.x() / (half_mm * half_mm));
        at = from + (height - from.z()) / way.z() * way;
      }
      at.z() = 0;
      const Eigen::Vector2d source = ImageFromCamera(camera, camera_from_sample * at);
      columns.at<float>(j, i) = static_cast<float>(source.x() - pixel.x());
      rows.at<float>(j, i) = static_cast<float>(source.y() - pixel.y());
    }
  }
  cv::Mat from_x(picture.size(), CV_32F), from_y(picture.size(), CV_32F), bent;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const double u = (x + 0.5) / kStep_px, v = (y + 0.5) / kStep_px;
      const int i = static_cast<int>(u), j = static_cast<int>(v);
      const auto between = [&](const cv::Mat& shift) {
        return (1 - v + j) *
                   ((1 - u + i) * shift.at<float>(j, i) + (u - i) * shift.at<float>(j, i + 1)) +
               (v - j) * ((1 - u + i) * shift.at<float>(j + 1, i) +
                          (u - i) * shift.at<float>(j + 1, i + 1));
      };
      from_x.at<float>(y, x) = static_cast<float>(x + between(columns));
      from_y.at<float>(y, x) = static_cast<float>(y + between(rows));
    }
  }
  cv::remap(picture, bent, from_x, from_y, cv::INTER_LANCZOS4, cv::BORDER_REPLICATE);
  return bent;
}

cv::Mat Turned(const cv::Mat& picture, cv::RotateFlags turn) {
  cv::Mat turned;
  cv::rotate(picture, turned, turn);
  return turned;
}

TEST_F(BoardLight, GoodPhotographsHaveNothingSaidOfThem) {
  const test::Outcome outcome = Calibrate();
  ExpectTheLight();
  EXPECT_THAT(outcome.err, Not(HasSubstr("warning")));
  EXPECT_FALSE(Result().data.contains("tone_curve"));
}

TEST_F(BoardLight, PixelsThatAnAppTurnedAreOfTheSameCamera) {
  const auto turn = [](cv::RotateFlags flags) {
    return [flags](const cv::Mat& picture) { return Turned(picture, flags); };
  };
  Change(1, turn(cv::ROTATE_90_CLOCKWISE));
  Change(3, turn(cv::ROTATE_90_COUNTERCLOCKWISE));
  Change(5, turn(cv::ROTATE_180));
  const test::Outcome outcome = Calibrate();
  ExpectTheLight();
  EXPECT_THAT(outcome.err, HasSubstr("photo_001.jpg, photos/photo_003.jpg, photos/photo_005.jpg: "
                                     "the pixels were turned"));
  const Calibration found = ReadCalibration(capture_ / "glint/calib/manifest.json");
  ASSERT_EQ(found.photos.size(), 6u);
  for (size_t i = 0; i < 6; ++i) {  // the light is where it was
    const Eigen::Vector3d light =
        Inverse(found.photos[i].camera_from_sample) * found.photos[i].light_in_camera_mm;
    const Eigen::Vector3d expected =
        Inverse(truth_.photos[i].camera_from_sample) * truth_.photos[i].light_in_camera_mm;
    EXPECT_LT((light - expected).norm(), 5) << i;
  }
}

TEST_F(BoardLight, AnEnlargedPhotographIsLeftOutByName) {
  Change(0, [](const cv::Mat& picture) {
    const double scale = 1.25;
    const cv::Mat about = (cv::Mat_<double>(2, 3) << scale, 0, (1 - scale) * picture.cols / 2,  //
                           0, scale, (1 - scale) * picture.rows / 2);
    cv::Mat enlarged;
    cv::warpAffine(picture, enlarged, about, picture.size(), cv::INTER_LANCZOS4);
    return enlarged;
  });
  const test::Outcome outcome = Calibrate();
  ExpectTheLight();
  EXPECT_THAT(outcome.err, HasSubstr("photo_000.jpg is left out: its paper is"));
  EXPECT_THAT(outcome.err, HasSubstr("it was taken with a zoom of about 1.2 that EXIF does not"));
  EXPECT_THAT(Calibrate("--check").out, HasSubstr("photo_000.jpg: its paper is"));
}

TEST_F(BoardLight, APhonesToneCurveIsFoundAndUsed) {
  for (int i = 0; i < 6; ++i) {
    Change(i, [](const cv::Mat& picture) {
      cv::Mat curve(1, 256, CV_8U), toned;
      for (int code = 0; code < 256; ++code) {
        const double x = code / 255.0;
        const double lifted = x + 0.18 * std::sin(std::numbers::pi * x) * (0.6 - x);
        curve.at<unsigned char>(code) = cv::saturate_cast<unsigned char>(255 * lifted);
      }
      cv::LUT(picture, curve, toned);
      return toned;
    });
  }
  const test::Outcome outcome = Calibrate();
  ExpectTheLight();
  const std::string words = "the paper's brightness contradicts the tone curve";
  EXPECT_THAT(outcome.err, HasSubstr(words));
  EXPECT_THAT(Calibrate("--check").out, HasSubstr(words));
  EXPECT_EQ(Result().data["tone_curve"], "tone_curve.json");
  const test::Outcome rectified =
      test::RunProgram({testing::Program("glint-rectify"), capture_.string()});
  EXPECT_EQ(rectified.code, 0) << rectified.err;
}

TEST_F(BoardLight, AWhiteBalanceThatDriftsIsToldAndTakenOut) {
  Change(2, [](const cv::Mat& picture) {
    cv::Mat tinted;
    cv::multiply(picture, cv::Scalar(1, 1, 1.03), tinted);  // R, G, B as stored
    return tinted;
  });
  const test::Outcome outcome = Calibrate();
  ExpectTheLight();
  EXPECT_THAT(outcome.err, HasSubstr("photo_002.jpg: the white paper has another colour"));
  const Calibration found = ReadCalibration(capture_ / "glint/calib/manifest.json");
  const Eigen::Vector3d& balance = found.photos[2].white_balance_rgb;
  EXPECT_NEAR(balance[2] / balance[1], std::pow(1.03, 2.2), 0.015);
  EXPECT_EQ(found.photos[3].white_balance_rgb, Eigen::Vector3d::Ones());
}

// Read with gamma 2.2, the flash would be 7 mm behind the lens and 9 % too strong.
TEST_F(BoardLight, PhotographsStoredBySrgbsCurveAreReadByIt) {
  capture_ = folder_ / "srgb";
  const test::Outcome made = test::RunProgram(
      {testing::Program("glint-synth"), "capture", capture_.string(), "--megapixels", "2",
       "--photos", "9", "--resolution", "128", "--seed", "42", "--encoding", "srgb"});
  ASSERT_EQ(made.code, 0) << made.err;
  LetTheEncodingBeFound(capture_);
  const Calibration truth = ReadCalibration(capture_ / "truth/calib/manifest.json");
  const test::Outcome outcome = Calibrate();
  const Json light = Result().metrics["light"]["board"];
  EXPECT_NEAR(light["flash_in_camera_mm"]["value"][2].get<double>(), 0, 3);
  EXPECT_NEAR(light["power_rgb"]["value"][1].get<double>() / truth.light_rgb[1], 1, 0.03);
  EXPECT_EQ(light["srgb"], true);
  EXPECT_THAT(outcome.out, HasSubstr("sRGB's tone curve explains the paper better"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("warning")));
  const ResponseCurve curve = ReadResponseCurve(capture_ / "glint/calib/tone_curve.json");
  for (const size_t code : {25, 120, 230}) {
    EXPECT_NEAR(curve.linear[1][code], LinearFromSrgb(code / 255.0), 1e-5) << code;
  }
}

// A sheet that arches by 2 mm, as paper with a window in it does.
TEST_F(BoardLight, ABendOfTheBoardIsFoundToldAndTakenIntoAccount) {
  constexpr double kHeight_mm = 2, kHalf_mm = 125;
  for (int i = 0; i < 6; ++i) {
    const Camera& camera = truth_.cameras[static_cast<size_t>(truth_.photos[i].camera)];
    const Rigid3& pose = truth_.photos[i].camera_from_sample;
    Change(i, [&](const cv::Mat& picture) {
      return OfBentBoard(picture, camera, pose, kHeight_mm, kHalf_mm);
    });
  }
  const test::Outcome outcome = Calibrate();
  ExpectTheLight();
  const std::string words = "the board is bent: its middle is ";
  EXPECT_THAT(outcome.err, HasSubstr(words));
  EXPECT_THAT(outcome.err, HasSubstr("the result takes that into account"));
  EXPECT_THAT(Calibrate("--check").out, HasSubstr(words));
  const Calibration found = ReadCalibration(capture_ / "glint/calib/manifest.json");
  EXPECT_NEAR(found.cameras[0].focal_length_x() / truth_.cameras[0].focal_length_x(), 1, 0.002);
  const test::Outcome exported =
      test::RunProgram({testing::Program("glint-calib"), capture_.string(), "--export", "colmap"});
  ASSERT_EQ(exported.code, 0) << exported.err;
  double highest_mm = 0;
  for (const ColmapPoint& point : ReadColmapModel(capture_ / "glint/colmap").points) {
    highest_mm = std::max(highest_mm, point.position.z());
  }
  EXPECT_NEAR(highest_mm, 1.4, 0.1);  // above the outermost corners, which are 208 mm apart
}

// By the room's lamps, automatically exposed: as bright as the others, and of no use.
TEST_F(BoardLight, APhotographWithoutFlashIsLeftOutByName) {
  Change(2, [](const cv::Mat& picture) {
    cv::Mat even(picture.size(), CV_32F), lit;
    for (int y = 0; y < picture.rows; ++y) {
      for (int x = 0; x < picture.cols; ++x) {
        const double across = static_cast<double>(x) / picture.cols - 0.5;
        const double down = static_cast<double>(y) / picture.rows - 0.5;
        even.at<float>(y, x) = static_cast<float>(1 + 0.5 * (across * across + down * down) * 2 +
                                                  0.35 * across - 0.15);
      }
    }
    cv::cvtColor(even, even, cv::COLOR_GRAY2BGR);
    picture.convertTo(lit, CV_32FC3);
    cv::multiply(lit, even, lit);
    lit.convertTo(lit, CV_8UC3);
    return lit;
  });
  const test::Outcome outcome = Calibrate();
  ExpectTheLight();
  EXPECT_THAT(outcome.err, HasSubstr("photo_002.jpg is left out: only "));
  EXPECT_THAT(outcome.err, HasSubstr("the flash did not fire, or a shadow or another lamp"));
}

TEST_F(BoardLight, ADarkPhotographHadNoFlashRatherThanAZoom) {
  Change(4, [](const cv::Mat& picture) {
    cv::Mat dark;
    picture.convertTo(dark, CV_8UC3, std::pow(0.1, 1 / 2.2));
    return dark;
  });
  const test::Outcome outcome = Calibrate();
  ExpectTheLight();
  EXPECT_THAT(outcome.err, HasSubstr("photo_004.jpg is left out: its paper is 90 % darker"));
  EXPECT_THAT(outcome.err, HasSubstr("the flash did not fire"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("zoom")));
}

TEST_F(BoardLight, AShadowOnThePaperIsTold) {
  Change(1, [](const cv::Mat& picture) {
    cv::Mat shaded = picture.clone();
    shaded(cv::Rect(0, 0, picture.cols, picture.rows / 3)) *= 0.7;
    return shaded;
  });
  const test::Outcome outcome = Calibrate();
  ExpectTheLight();
  EXPECT_THAT(outcome.err, HasSubstr("photo_001.jpg: parts of the white paper"));
}

// A phone that brightens the dark parts of a picture, by what lies around them.
TEST_F(BoardLight, LocalToneMappingIsNamed) {
  const auto brighten = [](const cv::Mat& picture) {
    cv::Mat linear, grey, around;
    picture.convertTo(linear, CV_32FC3, 1 / 255.0);
    cv::pow(linear, 2.2, linear);
    cv::cvtColor(linear, grey, cv::COLOR_RGB2GRAY);
    cv::log(grey + 1e-3, grey);
    cv::GaussianBlur(grey, around, {0, 0}, 60);
    cv::exp(-0.35 * (around - std::log(0.3)), around);
    cv::Mat gains, stored;
    cv::merge(std::vector<cv::Mat>{around, around, around}, gains);
    cv::pow(cv::min(linear.mul(gains), 1.0), 1 / 2.2, linear);
    linear.convertTo(stored, CV_8UC3, 255);
    return stored;
  };
  for (int photo = 0; photo < 6; ++photo) Change(photo, brighten);
  EXPECT_THAT(Calibrate().err, HasSubstr("brightness deviates locally"));
  EXPECT_THAT(Calibrate("--check").out, HasSubstr("brightness deviates locally"));
}

}  // namespace
}  // namespace glint
