#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <limits>

#include "pipeline/contract/errors.h"
#include "pipeline/contract/files.h"
#include "pipeline/contract/image.h"
#include "pipeline/contract/jpeg_end.h"
#include "pipeline/contract/memory_limit.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::HasSubstr;

Image Gradient(int width, int height, std::vector<std::string> channels) {
  Image image(width, height, std::move(channels));
  for (size_t i = 0; i < image.samples.size(); ++i) {
    image.samples[i] = static_cast<float>(i) / static_cast<float>(image.samples.size());
  }
  return image;
}

TEST(Exr, RoundTripKeepsEverySampleAndAttribute) {
  const test::TemporaryFolder folder;
  const Image image = Gradient(37, 21, {"R", "G", "B", "mask.Y"});
  WriteExr(folder / "a.exr", image, {{"note", "value"}});
  std::map<std::string, std::string> attributes;
  const Image read = ReadExr(folder / "a.exr", &attributes);
  ASSERT_EQ(read.width, 37);
  ASSERT_EQ(read.height, 21);
  for (const std::string& name : image.channels) {
    const auto wanted = image.channel(image.ChannelIndex(name));
    const int found = read.ChannelIndex(name);
    ASSERT_GE(found, 0) << name;
    EXPECT_TRUE(std::equal(wanted.begin(), wanted.end(), read.channel(found).begin())) << name;
  }
  EXPECT_EQ(attributes["note"], "value");
}

TEST(Exr, IdenticalImagesGiveIdenticalBytes) {
  const test::TemporaryFolder folder;
  const Image image = Gradient(64, 64, {"R", "G", "B"});
  WriteExr(folder / "a.exr", image);
  ::usleep(1100 * 1000);  // a time stamp would have a resolution of one second
  WriteExr(folder / "b.exr", image);
  EXPECT_EQ(ReadTextFile(folder / "a.exr"), ReadTextFile(folder / "b.exr"));
}

TEST(Photo, EightBitPngKeepsItsValues) {
  const test::TemporaryFolder folder;
  WritePng(folder / "a.png", Gradient(32, 32, {"R", "G", "B"}), 8);
  const Photo photo = ReadPhoto(folder / "a.png");
  EXPECT_EQ(photo.bits, 8);
  const Image wanted = Gradient(32, 32, {"R", "G", "B"});
  for (size_t i = 0; i < wanted.samples.size(); ++i) {
    ASSERT_NEAR(photo.image.samples[i], wanted.samples[i], 0.5 / 255 + 1e-6);
  }
}

// A disk that fills up in the middle of a picture, as a limit on file sizes plays it.
TEST(Image, APngThatDoesNotFitIsAnErrorAndNotAPartOfAFile) {
  const test::TemporaryFolder folder;
  Image image(256, 256, {"R", "G", "B"});
  unsigned state = 1;
  for (float& sample : image.samples) {
    state = state * 1664525u + 1013904223u;
    sample = static_cast<float>(state >> 8) / 16777216.0f;
  }
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{20 << 10, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(WritePng(folder / "large.png", image, 8), EnvironmentError);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(std::filesystem::exists(folder / "large.png"));
}

TEST(Photo, BadFilesAreNamed) {
  const test::TemporaryFolder folder;
  const auto complaint = [&](const std::string& name) {
    return test::MessageOf<UserError>([&] { ReadPhoto(folder / name); });
  };
  EXPECT_THAT(complaint("missing.jpg"), HasSubstr("no such file"));
  folder.Write("empty.jpg", "");
  EXPECT_THAT(complaint("empty.jpg"), HasSubstr("empty file"));
  folder.Write("text.jpg", "this is no photograph\n");
  EXPECT_THAT(complaint("text.jpg"), HasSubstr("text.jpg"));
  WritePng(folder / "dot.png", Gradient(1, 1, {"R", "G", "B"}));
  EXPECT_THAT(complaint("dot.png"), HasSubstr("1x1"));
  Image nan = Gradient(32, 32, {"R", "G", "B"});
  nan.samples[40] = std::numeric_limits<float>::quiet_NaN();
  WriteExr(folder / "nan.exr", nan);
  EXPECT_THAT(complaint("nan.exr"), HasSubstr("(8, 1)"));
}

// Segments as in ITU-T T.81: a table that holds an end marker, a scan with a stuffed byte and a
// restart marker, the end, and what a phone appends.
// A small file may hold a large picture: it is refused by its header.
TEST(Photo, APictureThatNeedsMoreMemoryThanAllowedIsRefusedBeforeItIsRead) {
  const test::TemporaryFolder folder;
  const auto file = folder / "white.png";
  WritePng(file, Image(3000, 2000, {"Y"}));
  EXPECT_LT(std::filesystem::file_size(file), 100000u);
  SetMemoryLimit(20000000);
  const std::string message = test::MessageOf<UserError>([&] { ReadPhoto(file); });
  SetMemoryLimit(0);
  EXPECT_THAT(message, HasSubstr("white.png: size: found 3000x2000 pixels of 1 channels"));
  EXPECT_THAT(message, HasSubstr("need 24 MB of memory; Glint may use 20 MB here"));
  EXPECT_EQ(ReadPhoto(file).image.width, 3000);
}

TEST(Photo, JpegIsCompleteUpToItsOwnEndMarker) {
  const std::string table("\xff\xdb\x00\x04\xff\xd9", 6), scan("\xff\xda\x00\x03\x01", 5);
  const std::string data("\x12\xff\x00\x34\xff\xd0\x56", 7), end = "\xff\xd9";
  const std::string whole = "\xff\xd8" + table + scan + data + end;
  EXPECT_TRUE(JpegIsComplete(whole));
  EXPECT_TRUE(JpegIsComplete(whole + "appended by a phone"));
  EXPECT_TRUE(JpegIsComplete("no JPEG"));
  for (size_t size = 2; size < whole.size(); ++size) {
    EXPECT_FALSE(JpegIsComplete(std::string_view(whole).substr(0, size))) << size;
  }
}

TEST(Photo, TruncatedPngIsRefused) {
  const test::TemporaryFolder folder;
  WritePng(folder / "whole.png", Gradient(256, 256, {"R", "G", "B"}), 16);
  const std::string bytes = ReadTextFile(folder / "whole.png");
  folder.Write("cut.png", bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadPhoto(folder / "cut.png"); }),
              HasSubstr("cut.png"));
}

}  // namespace
}  // namespace glint
