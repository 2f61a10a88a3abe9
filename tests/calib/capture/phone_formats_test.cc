// Videos and measured tone curves through glint-calib and glint-rectify, as a person runs them.
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/formats/calibration.h"
#include "base/formats/manifest.h"
#include "base/linearize/response_curve.h"
#include "tests/calib/capture/write_dng.h"
#include "tests/calib/testing/synthetic_photo.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::LookAt;

constexpr char kCaptureToml[] = R"([sample]
size_mm = [40, 40]
resolution_px = 32
[photos]
video = "clip.avi"
every = 3
[board]
squares = [8, 6]
square_mm = 20
marker_mm = 12
dictionary = "DICT_5X5_100"
)";

int RunGlint(const std::string& program, const fs::path& capture, const std::string& options,
             std::string* output) {
  const std::string command =
      std::string(GLINT_BIN_DIR) + "/" + program + " " + capture.string() + " " + options + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  output->clear();
  while (const size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) {
    output->append(buffer.data(), n);
  }
  return WEXITSTATUS(pclose(pipe));
}

// Six poses, each held for three frames, the last for six; then it is out of focus.
void WriteVideo(const fs::path& file) {
  cv::VideoWriter writer(file.string(), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                         30, cv::Size(640, 480));
  ASSERT_TRUE(writer.isOpened());
  for (int i = 0; i < 7; ++i) {
    const int pose = std::min(i, 5);
    testing::PhotoSettings settings;
    settings.samples = 2;
    settings.seed = static_cast<std::uint64_t>(i);
    const GrayImage gray =
        Photograph(testing::SmallBoard(), testing::SmallCamera(),
                   LookAt(230 + 5 * pose, 6 + 6 * pose, 100 * pose, 20 * pose), settings);
    cv::Mat frame(480, 640, CV_8UC1, const_cast<unsigned char*>(gray.samples.data())), colour;
    if (i == 6) cv::GaussianBlur(frame, frame, cv::Size(0, 0), 6);
    cv::cvtColor(frame, colour, cv::COLOR_GRAY2BGR);
    for (int held = 0; held < (i < 5 ? 3 : i == 5 ? 6 : 1); ++held) writer.write(colour);
  }
}

ResponseCurve SteepCurve() {
  ResponseCurve curve;
  for (auto& channel : curve.linear) {
    for (int i = 0; i < 256; ++i) channel.push_back(static_cast<float>(std::pow(i / 255.0, 3.0)));
  }
  return curve;
}

double MeanUsable(const fs::path& capture) {
  const Image view = ReadExr(capture / "glint/rectify/view_000.exr");
  double sum = 0;
  for (const float value : view.channel(view.ChannelIndex("G"))) sum += value;
  return sum / static_cast<double>(view.pixels());
}

// 16 bits, as stored by the sensor, with a tag that says how the phone was held.
void WriteTiff(const fs::path& file, const GrayImage& gray, int orientation) {
  const auto out = OIIO::ImageOutput::create(file.string());
  OIIO::ImageSpec spec(gray.width, gray.height, 3, OIIO::TypeUInt16);
  spec.attribute("Orientation", orientation);
  std::vector<std::uint16_t> samples;
  for (const unsigned char value : gray.samples) samples.insert(samples.end(), 3, 257 * value);
  ASSERT_TRUE(out->open(file.string(), spec));
  ASSERT_TRUE(out->write_image(OIIO::TypeUInt16, samples.data()));
  ASSERT_TRUE(out->close());
}

// The sensor's own values: RAW has no tone curve.
void WriteRaw(const fs::path& file, const GrayImage& gray, int orientation) {
  testing::DngWriter().Write(file, gray.width, gray.height, orientation,
                             [&](int x, int y) { return std::pow(gray.at(x, y) / 255.0, 2.2); });
}

// Six photographs of one camera, held as `orientations` say; "tif" or "dng".
void WriteCapture(const fs::path& capture, const std::string& ending,
                  const std::array<int, 6>& orientations) {
  fs::create_directories(capture / "photos");
  for (int i = 0; i < 6; ++i) {
    testing::PhotoSettings settings;
    settings.samples = 2;
    settings.seed = static_cast<std::uint64_t>(i);
    const auto write = ending == "dng" ? WriteRaw : WriteTiff;
    write(capture / "photos" / ("p" + std::to_string(i) + "." + ending),
          Photograph(testing::SmallBoard(), testing::SmallCamera(),
                     LookAt(230 + 5 * i, 6 + 6 * i, 100 * i, 20 * i), settings),
          orientations[static_cast<size_t>(i)]);
  }
  std::string toml = kCaptureToml;
  toml.replace(toml.find("video"), toml.find("[board]") - toml.find("video"),
               "files = [\"photos/*." + ending + "\"]\n");
  std::ofstream(capture / "capture.toml") << toml;
}

// Two captures of the same photographs give the same cameras and the same views.
void ExpectSame(const fs::path& a, const fs::path& b, double view_tolerance) {
  const Calibration first = ReadCalibration(a / "glint/calib/manifest.json");
  const Calibration second = ReadCalibration(b / "glint/calib/manifest.json");
  ASSERT_EQ(first.photos.size(), 6u);
  ASSERT_EQ(second.photos.size(), 6u);
  const double focal = first.cameras[0].focal_length_x();
  for (const Camera& camera : second.cameras) {  // one set of intrinsics, turned
    EXPECT_NEAR(camera.focal_length_x() / focal, 1, 1e-3);
  }
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_LT((Inverse(first.photos[i].camera_from_sample).translation -
               Inverse(second.photos[i].camera_from_sample).translation)
                  .norm(),
              0.2);
    const std::string view = "glint/rectify/view_00" + std::to_string(i) + ".exr";
    const Image x = ReadExr(a / view), y = ReadExr(b / view);
    ASSERT_EQ(x.samples.size(), y.samples.size());
    double difference = 0, sum = 0;
    for (size_t k = 0; k < x.samples.size(); ++k) {
      difference += std::abs(x.samples[k] - y.samples[k]);
      sum += x.samples[k];
    }
    EXPECT_LT(difference / sum, view_tolerance) << view;
  }
}

void CalibrateAndRectify(const fs::path& capture) {
  std::string output;
  ASSERT_EQ(RunGlint("glint-calib", capture, "", &output), 0) << output;
  ASSERT_EQ(RunGlint("glint-rectify", capture, "", &output), 0) << output;
}

TEST(PhoneFormats, UprightAndLevelPhotographsAreOneCameraInTiffAndInRaw) {
  const fs::path root = fs::temp_directory_path() / ("glint_turned_" + std::to_string(::getpid()));
  WriteCapture(root / "level", "tif", {1, 1, 1, 1, 1, 1});
  WriteCapture(root / "mixed", "tif", {1, 6, 3, 8, 6, 1});
  WriteCapture(root / "raw", "dng", {1, 6, 3, 8, 6, 1});
  for (const char* name : {"level", "mixed", "raw"}) CalibrateAndRectify(root / name);
  ExpectSame(root / "level", root / "mixed", 0.003);
  ExpectSame(root / "level", root / "raw", 0.02);  // demosaiced, and linear without being told so
  fs::remove_all(root);
}

TEST(PhoneFormats, FramesOfAVideoAreCalibratedRectifiedAndSorted) {
  const fs::path capture =
      fs::temp_directory_path() / ("glint_video_" + std::to_string(::getpid()));
  fs::create_directories(capture);
  WriteVideo(capture / "clip.avi");
  std::ofstream(capture / "capture.toml") << kCaptureToml;
  std::string output;
  ASSERT_EQ(RunGlint("glint-calib", capture, "", &output), 0) << output;
  EXPECT_THAT(output, HasSubstr("clip.avi#0018: shows the same as clip.avi#0015"));
  EXPECT_THAT(output, HasSubstr("clip.avi#0021: blurred"));
  EXPECT_THAT(output, HasSubstr("all exposures are assumed equal"));
  const Calibration calibration = ReadCalibration(capture / "glint/calib/manifest.json");
  ASSERT_EQ(calibration.photos.size(), 7u);
  EXPECT_EQ(calibration.photos[1].photo, "clip.avi#0003");
  EXPECT_NEAR(calibration.cameras[0].focal_length_x() / 560, 1, 0.006);

  ASSERT_EQ(RunGlint("glint-calib", capture, "--triage drop", &output), 0) << output;
  EXPECT_EQ(ReadCalibration(capture / "glint/calib/manifest.json").photos.size(), 6u) << output;
  ASSERT_EQ(RunGlint("glint-rectify", capture, "", &output), 0) << output;
  EXPECT_EQ(ReadManifest(capture / "glint/rectify/manifest.json", "rectify").inputs.size(), 2u);
  const double by_gamma = MeanUsable(capture);

  WriteResponseCurve(capture / "steep.json", SteepCurve());
  std::ofstream(capture / "capture.toml")
      << kCaptureToml << "[radiometry]\nencoding = \"steep.json\"\n";
  ASSERT_EQ(RunGlint("glint-calib", capture, "--triage drop", &output), 0) << output;
  ASSERT_EQ(RunGlint("glint-rectify", capture, "", &output), 0) << output;
  EXPECT_LT(MeanUsable(capture), 0.9 * by_gamma);
  // The curve is an input: another curve makes the result stale.
  EXPECT_EQ(ReadManifest(capture / "glint/rectify/manifest.json", "rectify").inputs.size(), 3u);
  std::ofstream(capture / "steep.json") << "{}";
  EXPECT_EQ(RunGlint("glint-rectify", capture, "", &output), 2);
  EXPECT_THAT(output, HasSubstr("steep.json"));
  fs::remove_all(capture);
}

}  // namespace
}  // namespace glint
