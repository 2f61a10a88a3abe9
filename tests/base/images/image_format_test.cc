#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/images/image.h"
#include "base/images/image_format.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::HasSubstr;
using namespace std::string_literals;

std::string ReaderOfBytes(const std::string& name, const std::string& bytes) {
  const test::TemporaryFolder folder;
  WriteFileAtomically(folder / name, bytes);
  return ReaderOf(folder / name);
}

TEST(ImageFormat, TheFirstBytesChooseTheReaderWhateverTheFileIsCalled) {
  EXPECT_EQ(ReaderOfBytes("a.png", "\xff\xd8\xff\xe0----------"), "jpeg");
  EXPECT_EQ(ReaderOfBytes("a.jpg", "\x89PNG\r\n\x1a\n----"), "png");
  EXPECT_EQ(ReaderOfBytes("a.jpg", "II*\0--------"s), "tiff");
  EXPECT_EQ(ReaderOfBytes("a.jpg", "MM\0*--------"s), "tiff");
  EXPECT_EQ(ReaderOfBytes("a", "\x76\x2f\x31\x01--------"), "openexr");
  EXPECT_EQ(ReaderOfBytes("a.jpg", "\0\0\0\x18"s + "ftypheic----"), "heif");
  EXPECT_EQ(ReaderOfBytes("a.pic", "#?RADIANCE\n-----"), "hdr");
  EXPECT_EQ(ReaderOfBytes("a.pic", "P6 2 2 255 ------"), "pnm");
}

TEST(ImageFormat, PhotographsAreKnownByTheirNames) {
  for (const char* name : {"a.JPG", "a.heic", "IMG_0001.HIF", "a.tiff", "a.dng", "a.webp"}) {
    EXPECT_TRUE(IsPhotoFileName(name)) << name;
  }
  EXPECT_FALSE(IsPhotoFileName("a.txt"));
}

TEST(ImageFormat, RawFilesThatBeginAsTiffFilesDoAreToldByTheirNames) {
  for (const char* name :
       {"a.NEF", "a.sr2", "a.rwl", "a.mef", "a.fff", "a.dcr", "a.mos", "a.ptx"}) {
    EXPECT_EQ(ReaderOfBytes(name, "MM\0*--------"s), "raw") << name;
  }
  EXPECT_EQ(ReaderOfBytes("a.raf", "FUJIFILMCCD-RAW "), "raw");
  EXPECT_EQ(ReaderOfBytes("a.nef", "\xff\xd8\xff\xe0----------"), "jpeg");
}

TEST(ImageFormat, NoReaderSeesWhatBeginsOtherwise) {
  for (const std::string& bytes : {""s, "II"s, "BM------------"s, "\0\0\x01\0------------"s,
                                   "GIF89a--------"s, "\0\0\0\x18"s + "ftypisom----"}) {
    EXPECT_EQ(ReaderOfBytes("a.jpg", bytes), "") << bytes;
  }
}

TEST(ImageFormat, AFileOfAnotherFormatIsRefusedByName) {
  const test::TemporaryFolder folder;
  WriteFileAtomically(folder / "icon.jpg", "\0\0\x01\0\x01\0--------------------------"s);
  const std::string message =
      test::MessageOf<UserError>([&] { ReadImageHeader(folder / "icon.jpg"); });
  EXPECT_THAT(message, HasSubstr("icon.jpg: found no image that can be read"));
  EXPECT_THAT(message, HasSubstr("give a JPEG, PNG, TIFF, EXR, HEIC or RAW file"));
}

}  // namespace
}  // namespace glint
