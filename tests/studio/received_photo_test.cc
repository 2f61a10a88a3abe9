#include "pipeline/studio/photographs/received_photo.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "pipeline/studio/http/http_types.h"
#include "tests/studio/picture.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::JpegBytes;

int StatusOfPhoto(const fs::path& folder, const std::string& name, const std::string& bytes) {
  try {
    ReceivedPhoto photo(folder, name);
    photo.Append(bytes);
    photo.Finish();
    photo.Keep();
    return 200;
  } catch (const HttpError& error) {
    return error.status;
  }
}

size_t FilesIn(const fs::path& folder) {
  return static_cast<size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(ReceivedPhoto, NamesOfClientsNeverBecomePaths) {
  EXPECT_EQ(PlainStem("../../etc/passwd"), "passwd");
  EXPECT_EQ(PlainStem("C:\\Users\\me\\IMG_0001.HEIC"), "IMG_0001");
  EXPECT_EQ(PlainStem("/abs/olute.jpg"), "olute");
  EXPECT_EQ(PlainStem(".."), "photograph");
  EXPECT_EQ(PlainStem(""), "photograph");
  EXPECT_EQ(PlainStem("photo 1 (2).jpeg"), "photo_1__2_");
  EXPECT_EQ(PlainStem(std::string("a\0b/c\nd.jpg", 11)).find_first_of("/\n"), std::string::npos);
  EXPECT_LE(PlainStem(std::string(5000, 'x')).size(), 100u);
}

TEST(ReceivedPhoto, TheContentSaysWhatItIs) {
  EXPECT_EQ(PhotoEnding(JpegBytes(1), "x.png"), ".jpg");
  EXPECT_EQ(PhotoEnding("\x89PNG\r\n\x1a\n____", "x.jpg"), ".png");
  EXPECT_EQ(PhotoEnding(std::string("\0\0\0\x18"
                                    "ftypheic\0\0\0\0",
                                    16),
                        "x"),
            ".heic");
  EXPECT_EQ(PhotoEnding(std::string("\0\0\0\x18"
                                    "ftypmp42\0\0\0\0",
                                    16),
                        "x.jpg"),
            "");
  EXPECT_EQ(PhotoEnding(std::string("II*\0aaaa", 8), "x.DNG"), ".dng");
  EXPECT_EQ(PhotoEnding(std::string("MM\0*aaaa", 8), "x.MEF"), ".mef");
  EXPECT_EQ(PhotoEnding(std::string("II*\0aaaa", 8), "x.exe"), ".tif");
  for (const char* text : {"", "R", "RIFF", "<html>", "#!/bin/sh", "%PDF-1.4", "PK\x03\x04"}) {
    EXPECT_EQ(PhotoEnding(text, "x.jpg"), "") << text;
  }
}

TEST(ReceivedPhoto, APhotographIsThereWholeOrNotAtAll) {
  const test::TemporaryFolder folder;
  const std::string bytes = JpegBytes(1);
  EXPECT_EQ(StatusOfPhoto(folder.path(), "a.jpg", "no picture, by no means"), 415);
  EXPECT_EQ(StatusOfPhoto(folder.path(), "a.jpg", ""), 415);
  EXPECT_EQ(StatusOfPhoto(folder.path(), "a.jpg", bytes.substr(0, bytes.size() / 2)), 400);
  EXPECT_EQ(StatusOfPhoto(folder.path(), "a.jpg", bytes.substr(0, 40)), 415);
  EXPECT_EQ(FilesIn(folder.path()), 0u);
  EXPECT_EQ(StatusOfPhoto(folder.path(), "a.jpg", bytes), 200);
  EXPECT_EQ(test::ReadAll(folder / "a.jpg"), bytes);
}

TEST(ReceivedPhoto, NothingIsWrittenOver) {
  const test::TemporaryFolder folder;
  folder.Write("a.jpg", "mine");
  EXPECT_EQ(StatusOfPhoto(folder.path(), "a.jpg", JpegBytes(1)), 200);
  EXPECT_EQ(test::ReadAll(folder / "a.jpg"), "mine");
  EXPECT_EQ(test::ReadAll(folder / "a-2.jpg"), JpegBytes(1));
}

TEST(ReceivedPhoto, ALinkOfTheSameNameIsNotFollowed) {
  const test::TemporaryFolder folder, elsewhere;
  elsewhere.Write("secret", "secret");
  fs::create_symlink(elsewhere / "secret", folder / "a.jpg");
  EXPECT_EQ(StatusOfPhoto(folder.path(), "a.jpg", JpegBytes(1)), 200);
  EXPECT_EQ(test::ReadAll(elsewhere / "secret"), "secret");
}

TEST(ReceivedPhoto, FilesLargerThanTheLimitAreRefusedBeforeTheyFillTheDisk) {
  const test::TemporaryFolder folder;
  ReceivedPhoto photo(folder.path(), "a.jpg");
  photo.Append(JpegBytes(1));
  const std::string piece(8 << 20, '\0');
  const auto fill = [&] {
    for (int i = 0; i < 30; ++i) photo.Append(piece);
  };
  EXPECT_THROW(fill(), HttpError);
}

TEST(ReceivedPhoto, AFullDiskIsToldAsSuch) {
  if (!fs::exists("/dev/full")) GTEST_SKIP();
  const test::TemporaryFolder folder;
  // A file-size limit stands in for a small disk.
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  const int status = StatusOfPhoto(folder.path(), "a.jpg", JpegBytes(1));
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_GE(status, 500);
  EXPECT_EQ(FilesIn(folder.path()), 0u);
}

TEST(ReceivedPhoto, LeftoversOfKilledUploadsGo) {
  const test::TemporaryFolder folder;
  folder.Write(".upload-1.jpg", "torn");
  folder.Write("b.jpg", "mine");
  ReceivedPhoto::RemoveLeftovers(folder.path());
  EXPECT_EQ(FilesIn(folder.path()), 1u);
}

}  // namespace
}  // namespace glint
