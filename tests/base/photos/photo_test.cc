// Photographs as phones write them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/images/image.h"
#include "base/images/oiio.h"
#include "base/photos/decode_count.h"
#include "base/photos/heic_turn.h"
#include "base/photos/photo.h"
#include "base/photos/photo_name.h"
#include "base/photos/upright.h"
#include "tests/support/data_folder.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

fs::path PhoneFolder() { return test::DataFolder() / "phone"; }

TEST(Photo, ExposureIsByTimeIsoAndAperture) {
  Photo photo;
  EXPECT_EQ(photo.exposure(), 0);
  photo.exposure_time_s = 0.01;
  photo.iso = 100;
  EXPECT_EQ(photo.exposure(), 0);  // two of three say nothing
  photo.f_number = 2;
  const double exposure = photo.exposure();
  photo.exposure_time_s *= 2;
  EXPECT_DOUBLE_EQ(photo.exposure(), 2 * exposure);
  photo.iso *= 2;
  EXPECT_DOUBLE_EQ(photo.exposure(), 4 * exposure);
  photo.f_number *= 2;
  EXPECT_DOUBLE_EQ(photo.exposure(), exposure);
}

TEST(PhotoName, OnlyFramesOfVideosAreSplit) {
  EXPECT_EQ(SplitPhotoName("a/clip.MP4#0030").frame, 30);
  EXPECT_EQ(SplitPhotoName("a/clip.MP4#0030").file, "a/clip.MP4");
  for (const char* name : {"a#1.jpg", "a.jpg#12", "clip.mp4", "clip.mp4#", "clip.mp4#1x", "#3"}) {
    EXPECT_EQ(SplitPhotoName(name).frame, -1) << name;
    EXPECT_EQ(SplitPhotoName(name).file, name);
  }
  EXPECT_EQ(SplitPhotoName(FrameName("v.mov", 123456)).frame, 123456);
  EXPECT_THAT(FilesOfPhotos({"v.mov#0000", "a.jpg", "v.mov#0015"}), ElementsAre("v.mov", "a.jpg"));
}

TEST(PhotoName, ListsOfNamesMayHoldNamesWithCommas) {
  const auto known = [](const std::string& name) {
    for (const char* photo : {"p/a,b.jpg", "p/c.jpg", "p/d,e,f.jpg"}) {
      if (NamesPhoto(name, photo)) return true;
    }
    return false;
  };
  EXPECT_THAT(RejoinedNames({"a", "b.jpg", "c.jpg"}, known), ElementsAre("a,b.jpg", "c.jpg"));
  EXPECT_THAT(RejoinedNames({"c", "d", "e", "f"}, known), ElementsAre("c", "d,e,f"));
  EXPECT_THAT(RejoinedNames({"x", "c", "a"}, known), ElementsAre("x", "c", "a"));
}

// The picture 1 2 3 / 4 5 6 as EXIF's eight orientations store it (EXIF 2.3, tag 0x0112).
TEST(Upright, AllEightOrientationsGiveTheSamePicture) {
  const std::vector<std::vector<std::uint16_t>> stored = {
      {1, 2, 3, 4, 5, 6}, {3, 2, 1, 6, 5, 4}, {6, 5, 4, 3, 2, 1}, {4, 5, 6, 1, 2, 3},
      {1, 4, 2, 5, 3, 6}, {3, 6, 2, 5, 1, 4}, {6, 3, 5, 2, 4, 1}, {4, 1, 5, 2, 6, 3}};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const bool turned = TurnExchangesAxes(orientation);
    const StoredImage image =
        UprightImage(stored[orientation - 1], {turned ? 2 : 3, turned ? 3 : 2, 1}, orientation);
    ASSERT_EQ(image.width, 3) << orientation;
    image.Visit([&](const auto& samples) {
      ASSERT_EQ(samples.size(), 18u);
      for (size_t i = 0; i < 18; ++i) EXPECT_EQ(samples[i], i / 3 + 1) << orientation << ", " << i;
    });
  }
}

TEST(Upright, APhonesEightOrientationsLookTheSame) {
  if (!fs::exists(PhoneFolder())) GTEST_SKIP() << "no data";
  const Photo first = ReadPhoto(PhoneFolder() / "orientation/landscape_1.jpg");
  for (int orientation = 2; orientation <= 8; ++orientation) {
    const Photo photo = ReadPhoto(PhoneFolder() / "orientation" /
                                  ("landscape_" + std::to_string(orientation) + ".jpg"));
    EXPECT_EQ(photo.orientation, orientation);
    ASSERT_EQ(photo.image.width, first.image.width);
    // They were saved one by one; the same picture is told from a mirrored one.
    double same = 0, mirrored = 0;
    for (int y = 0; y < 450; ++y) {
      for (int x = 0; x < 600; ++x) {
        const float wanted = first.image.at(y * 600 + x, 0);
        same += std::abs(photo.image.at(y * 600 + x, 0) - wanted);
        mirrored += std::abs(photo.image.at(y * 600 + 599 - x, 0) - wanted);
      }
    }
    EXPECT_LT(same, 0.4 * mirrored) << orientation;
  }
}

std::string BigEndian(unsigned value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i) & 0xff);
  return text;
}

std::string Box(const std::string& type, const std::string& content) {
  return BigEndian(static_cast<unsigned>(content.size() + 8), 4) + type + content;
}

// A HEIC's description: two items, of which the second is the primary one and turned.
std::string Heic(const std::string& turn) {
  const std::string ipco =
      Box("ipco", Box("ispe", BigEndian(0, 4) + BigEndian(400, 4) + BigEndian(300, 4)) + turn +
                      Box("irot", BigEndian(2, 1)));
  const std::string ipma =
      Box("ipma", BigEndian(0, 4) + BigEndian(2, 4) +                           //
                      BigEndian(7, 2) + BigEndian(1, 1) + BigEndian(0x83, 1) +  // item 7: the last
                      BigEndian(9, 2) + BigEndian(2, 1) + BigEndian(0x81, 1) + BigEndian(0x82, 1));
  return Box("ftyp", "heic") +
         Box("meta", BigEndian(0, 4) + Box("pitm", BigEndian(0, 4) + BigEndian(9, 2)) +
                         Box("iprp", ipco + ipma));
}

TEST(HeicTurn, IsThatOfThePrimaryPicture) {
  // irot counts quarter turns anticlockwise.
  const int wanted[] = {1, 8, 3, 6};
  for (unsigned turns = 0; turns < 4; ++turns) {
    const std::string file = Heic(Box("irot", BigEndian(turns, 1)));
    EXPECT_EQ(HeicOrientation(std::string_view(file)), wanted[turns]);
    for (size_t size = 0; size < file.size(); ++size) {  // cut anywhere: an answer, no more
      const int orientation = HeicOrientation(std::string_view(file).substr(0, size));
      EXPECT_GE(orientation, 1);
      EXPECT_LE(orientation, 8);
    }
  }
  EXPECT_EQ(HeicOrientation(std::string_view(Heic(Box("imir", BigEndian(1, 1))))), 2);
}

TEST(Photo, HeicAndRawAreReadWithTheirExif) {
  if (!fs::exists(PhoneFolder())) GTEST_SKIP() << "no data";
  const Photo heic = ReadPhoto(PhoneFolder() / "heic/ianare_IMG_5195.HEIC");
  EXPECT_EQ(heic.format, "heif");
  EXPECT_EQ(heic.camera_model, "Apple iPhone 11 Pro Max");
  EXPECT_NEAR(heic.exposure_time_s, 1.0 / 391, 1e-6);
  EXPECT_EQ(heic.iso, 32);
  EXPECT_EQ(heic.focal_length_35mm, 26);
  EXPECT_EQ(heic.exif.width_px, 4032);  // and the picture has 2566: it was cropped

  EXPECT_EQ(ReadPhoto(PhoneFolder() / "raw/RAW_KODAK_DC50.KDC").iso, 84);
  const fs::path dng = PhoneFolder() / "raw/colorchart.dng";
  const Photo raw = ReadPhoto(dng);
  EXPECT_EQ(raw.format, "raw");
  EXPECT_EQ(raw.bits, 16);
  EXPECT_TRUE(raw.exif.focal_is_zero);
  EXPECT_TRUE(raw.exif.iso_is_zero);
  EXPECT_EQ(raw.exposure(), 0);
  EXPECT_GT(raw.exif.white_balance[0], 1.5);

  // The same sensor held upright (orientation 6 in the file's first directory).
  const test::TemporaryFolder folder;
  std::string bytes = ReadTextFile(dng, 64u << 20);
  const std::string tag("\x12\x01\x03\x00\x01\x00\x00\x00\x01\x00", 10);
  const size_t at = bytes.find(tag);
  ASSERT_NE(at, std::string::npos);
  bytes[at + 8] = 6;
  folder.Write("upright.dng", bytes);
  const Photo upright = ReadPhoto(folder / "upright.dng");
  EXPECT_EQ(upright.orientation, 6);
  EXPECT_EQ(upright.image.width, raw.image.height);
  EXPECT_EQ(PhotoSize(folder / "upright.dng"), std::pair(raw.image.height, raw.image.width));
  folder.Write("cut.dng", bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadPhoto(folder / "cut.dng"); }),
              HasSubstr("copy the photograph again"));
}

TEST(Photo, OnlyDecodedPhotographsAreCounted) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "a.png";
  WritePng(file, Image(64, 48, {"R", "G", "B"}));
  const std::int64_t before = PhotosDecoded().whole;
  PhotoSize(file);
  EXPECT_THROW(ReadPhoto(folder / "none.png"), UserError);
  EXPECT_EQ(PhotosDecoded().whole, before);
  ReadPhoto(file);
  ReadPhoto(file);
  EXPECT_EQ(PhotosDecoded().whole, before + 2);
}

TEST(Photo, RawThatIsNoneIsRefused) {
  const test::TemporaryFolder folder;
  WritePng(folder / "a.png", Image(64, 64, {"R", "G", "B"}));
  fs::rename(folder / "a.png", folder / "preview.nef");
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadPhoto(folder / "preview.nef"); }),
              HasSubstr("convert it to DNG"));
  folder.Write("unknown.cr3", std::string(5000, 'x'));
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadPhoto(folder / "unknown.cr3"); }),
              HasSubstr("a camera that LibRaw does not know"));
}

// Their readers would allocate what a length says, before they look for the bytes.
TEST(Photo, LengthsBeyondTheFileAreRefusedWhateverItIsCalled) {
  const test::TemporaryFolder folder;
  const std::string exr("\x76\x2f\x31\x01\x02\0\0\0note\0string\0\xff\xff\xff\x7fshort", 29);
  EXPECT_THAT(test::MessageOf<UserError>([&] { PhotoSize(folder.Write("a.jpg", exr)); }),
              HasSubstr("an attribute of 2147483647 bytes in a file of 29"));
  const std::string png("\x89PNG\r\n\x1a\n\x58\x04\xf9\0tEXtshort", 21);
  EXPECT_THAT(test::MessageOf<UserError>([&] { PhotoSize(folder.Write("b.jpg", png)); }),
              HasSubstr("a chunk of 1476720896 bytes in a file of 21"));
}

TEST(Photo, HeicWithoutDecoderIsTheEnvironmentsFault) {
  const test::TemporaryFolder folder;
  const fs::path heic = folder.Write("a.heic", Heic(Box("irot", BigEndian(1, 1))));
  const auto complaint = [&](const std::string& reason, const std::string& formats) {
    return test::MessageOf<EnvironmentError>([&] { RejectUnreadable(heic, reason, formats); });
  };
  EXPECT_THAT(complaint("no reader", "bmp,jpeg,png"), HasSubstr("convert the photographs to JPEG"));
  EXPECT_THAT(complaint("Unsupported codec", "bmp,heif,png"), HasSubstr("install libheif1"));
  EXPECT_THROW(RejectUnreadable(heic, "Unexpected end of file", "bmp,heif,png"), UserError);
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadPhoto(heic); }), HasSubstr("a.heic"));
}

}  // namespace
}  // namespace glint
