#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/memory_limit.h"
#include "base/images/image.h"
#include "base/photos/jpeg_end.h"
#include "base/photos/photo.h"
#include "tests/base/images/gradient_image.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using test::Gradient;
using ::testing::HasSubstr;

TEST(Photo, EightBitPngKeepsItsValues) {
  const test::TemporaryFolder folder;
  WritePng(folder / "a.png", Gradient(32, 32, {"R", "G", "B"}), 8);
  const Photo photo = ReadPhoto(folder / "a.png");
  EXPECT_EQ(photo.bits, 8);
  const Image shown = photo.image.Planes(), wanted = Gradient(32, 32, {"R", "G", "B"});
  for (size_t i = 0; i < wanted.samples.size(); ++i) {
    ASSERT_NEAR(shown.samples[i], wanted.samples[i], 0.5 / 255 + 1e-6);
  }
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

// Segments as in ITU-T T.81: a table that holds an end marker, a scan with a stuffed byte and a
// restart marker, the end, and what a phone appends.
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
