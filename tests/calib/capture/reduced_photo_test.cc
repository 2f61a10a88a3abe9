#include "calib/capture/reduced_photo.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/errors/errors.h"
#include "base/photos/decode_count.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 416, kHeight = 304;

// Three slow waves, none of them symmetric.
void WriteJpeg(const fs::path& file, int orientation) {
  std::vector<unsigned char> bytes(3 * kWidth * kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double wave = std::sin(0.01 * (c + 1) * x + 0.02 * y + c);
        bytes[3 * (y * kWidth + x) + c] = static_cast<unsigned char>(std::lround(128 + 100 * wave));
      }
    }
  }
  OIIO::ImageSpec spec(kWidth, kHeight, 3, OIIO::TypeUInt8);
  spec.attribute("Orientation", orientation);
  spec.attribute("Exif:FocalLengthIn35mmFilm", 26);
  spec.attribute("CompressionQuality", 95);
  const auto output = OIIO::ImageOutput::create(file.string());
  ASSERT_TRUE(output->open(file.string(), spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeUInt8, bytes.data()));
  output->close();
}

float BlockMean(const StoredImage& image, int c, int x0, int y0, int side) {
  float sum = 0;
  for (int y = y0; y < y0 + side; ++y) {
    for (int x = x0; x < x0 + side; ++x) sum += image.at(y * image.width + x, c);
  }
  return sum / static_cast<float>(side * side);
}

TEST(ReducedPhoto, IsTheWholePhotographShrunkForEveryOrientation) {
  const test::TemporaryFolder folder;
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const fs::path file = folder.path() / (std::to_string(orientation) + ".jpg");
    WriteJpeg(file, orientation);
    const Photo whole = ReadPhoto(file);
    int reduction = 0;
    const Photo small = ReadReducedPhoto(file, 110, &reduction);
    ASSERT_EQ(reduction, 4);
    EXPECT_EQ(small.orientation, orientation);
    EXPECT_EQ(small.focal_length_35mm, 26);
    ASSERT_EQ(small.image.width * 4, whole.image.width);
    ASSERT_EQ(small.image.height * 4, whole.image.height);
    for (int y = 0; y < small.image.height; ++y) {
      for (int x = 0; x < small.image.width; ++x) {
        for (int c = 0; c < 3; ++c) {
          ASSERT_NEAR(small.image.at(y * small.image.width + x, c),
                      BlockMean(whole.image, c, 4 * x, 4 * y, 4), 0.03)
              << orientation << " at " << x << ", " << y;
        }
      }
    }
  }
}

TEST(ReducedPhoto, IsCountedApartFromWholeOnes) {
  const test::TemporaryFolder folder;
  WriteJpeg(folder.path() / "a.jpg", 1);
  const DecodeCounts before = PhotosDecoded();
  int reduction = 0;
  ReadReducedPhoto(folder.path() / "a.jpg", 110, &reduction);
  EXPECT_EQ(PhotosDecoded().reduced, before.reduced + 1);
  EXPECT_EQ(PhotosDecoded().whole, before.whole);
  ReadReducedPhoto(folder.path() / "a.jpg", 416, &reduction);  // small enough to be read whole
  EXPECT_EQ(PhotosDecoded().reduced, before.reduced + 1);
  EXPECT_EQ(PhotosDecoded().whole, before.whole + 1);
}

TEST(ReducedPhoto, IsWholeWhereItIsSmallEnough) {
  const test::TemporaryFolder folder;
  WriteJpeg(folder.path() / "a.jpg", 1);
  int reduction = 0;
  EXPECT_EQ(ReadReducedPhoto(folder.path() / "a.jpg", 416, &reduction).image.width, kWidth);
  EXPECT_EQ(reduction, 1);
}

TEST(ReducedPhoto, RefusesWhatIsCutOffOrNoPicture) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "a.jpg";
  WriteJpeg(file, 1);
  int reduction = 0;
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_THROW(ReadReducedPhoto(file, 100, &reduction), UserError);
  test::WriteAll(file, "no picture");
  EXPECT_THROW(ReadReducedPhoto(file, 100, &reduction), UserError);
}

}  // namespace
}  // namespace glint
