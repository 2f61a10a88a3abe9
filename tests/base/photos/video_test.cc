// Frames of videos as photographs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/capture.h"
#include "base/photos/photo.h"
#include "base/photos/photo_name.h"
#include "base/photos/video.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kFrames = 40, kWidth = 160, kHeight = 96;

int GreyOf(int frame) { return 30 + 5 * frame; }

// Frame i is grey of GreyOf(i), its left third darker by half.
void WriteVideo(const std::filesystem::path& file, const char* codec) {
  cv::VideoWriter writer(file.string(), cv::CAP_FFMPEG,
                         cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]), 30,
                         cv::Size(kWidth, kHeight));
  if (!writer.isOpened()) GTEST_SKIP() << "no encoder";
  for (int i = 0; i < kFrames; ++i) {
    cv::Mat frame(kHeight, kWidth, CV_8UC3, cv::Scalar::all(GreyOf(i)));
    frame.colRange(0, kWidth / 3).setTo(cv::Scalar::all(GreyOf(i) / 2));
    writer.write(frame);
  }
}

float At(const Photo& photo, int x, int y) {
  return 255 * photo.image.at(static_cast<size_t>(y) * photo.image.width + x, 1);
}

TEST(Video, AnyFrameIsReadExactlyInAnyOrder) {
  const test::TemporaryFolder folder;
  for (const auto& [name, codec] : {std::pair{"a.mp4", "mp4v"}, std::pair{"a.avi", "MJPG"}}) {
    WriteVideo(folder / name, codec);
    EXPECT_EQ(ReadVideoInfo(folder / name).frames, kFrames);
    EXPECT_EQ(ReadVideoInfo(folder / name).missing, 0);
    for (const int frame : {31, 0, 7, 39, 12, 13}) {
      const Photo photo = ReadPhoto(folder / FrameName(name, frame));
      EXPECT_EQ(photo.bits, 8);
      EXPECT_NEAR(At(photo, 120, 50), GreyOf(frame), 2) << name << " " << frame;
      EXPECT_NEAR(At(photo, 20, 50), GreyOf(frame) / 2, 2) << name << " " << frame;
    }
    EXPECT_EQ(PhotoSize(folder / FrameName(name, 3)), std::pair(kWidth, kHeight));
  }
}

// Playlists and scripts would have other files read than the capture's, which nothing hashes.
TEST(Video, PlaylistsAndScriptsUnderAVideosNameAreRefused) {
  const test::TemporaryFolder folder;
  WriteVideo(folder / "real.avi", "MJPG");
  const std::string real = (folder / "real.avi").string();
  const auto hls = folder.Write(
      "hls.mp4", "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n" + real + "\n#EXT-X-ENDLIST\n");
  const auto script = folder.Write("script.mp4", "ffconcat version 1.0\nfile '" + real + "'\n");
  for (const auto& file : {hls, script}) {
    EXPECT_THAT(test::MessageOf<UserError>([&] { ReadVideoInfo(file); }),
                HasSubstr("no video that can be read"))
        << file;
  }
  EXPECT_EQ(ReadVideoInfo(folder / "real.avi").frames, kFrames);
}

TEST(Video, OneThatIsHeldUprightIsTurned) {
  const test::TemporaryFolder folder;
  WriteVideo(folder / "a.mp4", "mp4v");
  std::string bytes = ReadTextFile(folder / "a.mp4");
  // The matrix of the track header stands 44 bytes behind the box's name (ISO/IEC 14496-12, 8.3.2).
  const size_t matrix = bytes.find("tkhd") + 44;
  const std::string quarter_turn(
      "\0\0\0\0\0\1\0\0\0\0\0\0\xff\xff\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x40\0\0\0", 36);
  bytes.replace(matrix, 36, quarter_turn);
  folder.Write("turned.mp4", bytes);
  const Photo photo = ReadPhoto(folder / "turned.mp4#0020");
  EXPECT_EQ(photo.orientation, 6);
  EXPECT_EQ(photo.image.width, kHeight);
  EXPECT_NEAR(At(photo, 50, 20), GreyOf(20) / 2, 2);  // the left third is at the top now
  EXPECT_NEAR(At(photo, 50, 120), GreyOf(20), 2);
}

TEST(Video, CutOffIsSaidOrItsWholeFramesAreUsed) {
  const test::TemporaryFolder folder;
  WriteVideo(folder / "a.mp4", "mp4v");
  WriteVideo(folder / "a.avi", "MJPG");
  const std::string mp4 = ReadTextFile(folder / "a.mp4"), avi = ReadTextFile(folder / "a.avi");
  folder.Write("cut.mp4", mp4.substr(0, mp4.size() / 2));  // its index stood at the end
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadVideoInfo(folder / "cut.mp4"); }),
              HasSubstr("copied only in part"));
  folder.Write("cut.avi", avi.substr(0, avi.size() / 2));
  const VideoInfo info = ReadVideoInfo(folder / "cut.avi");
  EXPECT_GT(info.frames, kFrames / 4);
  EXPECT_LT(info.frames, 3 * kFrames / 4);
  EXPECT_EQ(info.frames + info.missing, kFrames);
  const Photo last = ReadPhoto(folder / FrameName("cut.avi", info.frames - 1));
  EXPECT_NEAR(At(last, 120, 90), GreyOf(info.frames - 1), 2);
  EXPECT_THAT(
      test::MessageOf<UserError>([&] { ReadPhoto(folder / FrameName("cut.avi", info.frames)); }),
      HasSubstr("complete frames"));
  folder.Write("text.mp4", "no video at all");
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadVideoInfo(folder / "text.mp4"); }),
              HasSubstr("text.mp4"));
}

TEST(Video, ACaptureNamesOneFrameInSoMany) {
  const test::TemporaryFolder folder;
  WriteVideo(folder / "clip.mp4", "mp4v");
  const std::string sample = "[sample]\nsize_mm = [50, 50]\n";
  folder.Write("capture.toml", sample + "[photos]\nvideo = \"clip.mp4\"\nevery = 15\n");
  const Capture capture = ReadCapture(folder.path());
  EXPECT_THAT(capture.photos, ElementsAre("clip.mp4#0000", "clip.mp4#0015", "clip.mp4#0030"));
  EXPECT_THAT(capture.FilesBehind(capture.photos), ElementsAre(folder / "clip.mp4"));
  folder.Write("capture.toml", sample + "[photos]\nvideo = \"none.mp4\"\n");
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadCapture(folder.path()); }),
              HasSubstr("photos.video"));
}

}  // namespace
}  // namespace glint
