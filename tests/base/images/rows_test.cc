// Images that are read and written by rows are those that are read and written whole.
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/memory_limit.h"
#include "base/images/exr_rows.h"
#include "base/images/png_rows.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::HasSubstr;

Image Waves(int width, int height, const std::vector<std::string>& channels) {
  Image image(width, height, channels);
  for (size_t i = 0; i < image.samples.size(); ++i) {
    image.samples[i] = 0.5f + 0.5f * std::sin(0.37f * static_cast<float>(i));
  }
  return image;
}

Image RowsOf(const Image& image, int first, int rows) {
  Image part(image.width, rows, image.channels);
  const auto begin = static_cast<std::ptrdiff_t>(first) * image.width;
  for (int c = 0; c < static_cast<int>(image.channels.size()); ++c) {
    const auto from = image.channel(c).begin() + begin;
    std::copy(from, from + static_cast<std::ptrdiff_t>(part.pixels()), part.channel(c).begin());
  }
  return part;
}

template <class Writer>
void WriteByRows(const Image& image, int at_once, Writer* writer) {
  for (int first = 0; first < image.height; first += at_once) {
    writer->Write(RowsOf(image, first, std::min(at_once, image.height - first)));
  }
  writer->Close();
}

TEST(ExrRows, HaveTheSameBytesHoweverTheyAreCut) {
  const test::TemporaryFolder folder;
  const Image image = Waves(33, 150, {"R", "G", "B", "mask.Y"});
  WriteExr(folder / "whole.exr", image, {{"note", "value"}});
  for (const int at_once : {1, 7, 16, 64, 149}) {
    ExrWriter writer(folder / "rows.exr", 33, 150, image.channels, {{"note", "value"}});
    WriteByRows(image, at_once, &writer);
    EXPECT_EQ(ReadTextFile(folder / "rows.exr"), ReadTextFile(folder / "whole.exr")) << at_once;
  }
}

TEST(ExrRows, AsHalfFloatsRoundByLessThanTwoToTheMinusEleven) {
  const test::TemporaryFolder folder;
  Image image(64, 20, {"R"});
  for (size_t i = 0; i < image.pixels(); ++i) {
    image.samples[i] = 6.2e-5f * std::pow(1.016f, static_cast<float>(i));  // to 4e4
  }
  image.samples.back() = 1e6f;
  const auto written = [&](int at_once) {
    ExrWriter writer(folder / "half.exr", 64, 20, {"R"}, {}, ExrPrecision::kHalf);
    WriteByRows(image, at_once, &writer);
    return ReadTextFile(folder / "half.exr");
  };
  EXPECT_EQ(written(7), written(20));
  const Image half = ReadExr(folder / "half.exr");
  for (size_t i = 0; i + 1 < image.pixels(); ++i) {
    EXPECT_NEAR(half.samples[i], image.samples[i], image.samples[i] / 2048) << i;
  }
  EXPECT_EQ(half.samples.back(), 65504);
}

TEST(ExrRows, AreThoseOfTheWholeImageInAnyOrder) {
  const test::TemporaryFolder folder;
  const Image image = Waves(33, 150, {"R", "G", "B"});
  WriteExr(folder / "a.exr", image);
  ExrReader reader(folder / "a.exr");
  for (const auto& [first, rows] : {std::pair{140, 10}, std::pair{0, 150}, std::pair{17, 70}}) {
    EXPECT_EQ(reader.Read(first, rows).samples, RowsOf(image, first, rows).samples) << first;
  }
}

TEST(ExrRows, NeedMemoryForThemselvesAlone) {
  const test::TemporaryFolder folder;
  WriteExr(folder / "a.exr", Image(1000, 1000, {"R", "G", "B"}));
  SetMemoryLimit(2000000);
  ExrReader reader(folder / "a.exr");
  EXPECT_EQ(reader.Read(500, 100).height, 100);
  const std::string message = test::MessageOf<UserError>([&] { reader.Read(0, 1000); });
  SetMemoryLimit(0);
  EXPECT_THAT(message, HasSubstr("a.exr: size: found 1000x1000 pixels of 3 channels"));
}

void WriteTiled(const std::filesystem::path& file, const Image& image, int tile_height) {
  OIIO::ImageSpec spec(image.width, image.height, 1, OIIO::TypeFloat);
  spec.tile_width = 64;
  spec.tile_height = tile_height;
  const auto output = OIIO::ImageOutput::create("openexr");
  ASSERT_TRUE(output && output->open(file.string(), spec)) << OIIO::geterror();
  ASSERT_TRUE(output->write_image(OIIO::TypeFloat, image.samples.data())) << output->geterror();
  ASSERT_TRUE(output->close());
}

TEST(ExrRows, OfTilesAreThoseOfTheImage) {
  const test::TemporaryFolder folder;
  const Image image = Waves(150, 130, {"Y"});
  WriteTiled(folder / "a.exr", image, 32);
  EXPECT_EQ(ReadExr(folder / "a.exr").samples, image.samples);
  ExrReader reader(folder / "a.exr");
  EXPECT_EQ(reader.Read(17, 70).samples, RowsOf(image, 17, 70).samples);
}

TEST(ExrRows, OfTilesNeedMemoryForARowOfTiles) {
  const test::TemporaryFolder folder;
  WriteTiled(folder / "a.exr", Waves(64, 8, {"Y"}), 1 << 16);
  SetMemoryLimit(2000000);
  ExrReader reader(folder / "a.exr");
  const std::string message = test::MessageOf<UserError>([&] { reader.Read(0, 1); });
  SetMemoryLimit(0);
  EXPECT_THAT(message, HasSubstr("a.exr: size: found 64x65536 pixels of 1 channels"));
}

TEST(ExrRows, AreAveragedAsTheWholeIs) {
  const test::TemporaryFolder folder;
  const Image image = Waves(40, 1200, {"a", "b"});
  WriteExr(folder / "a.exr", image);
  const Image small = ReadExrAveraged(folder / "a.exr", {"b"}, 20, 3);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 20; ++column) {
      double sum = 0;
      for (int r = 400 * row; r < 400 * (row + 1); ++r) {
        for (int c = 2 * column; c < 2 * column + 2; ++c) {
          sum += image.channel(1)[size_t{40} * static_cast<size_t>(r) + static_cast<size_t>(c)];
        }
      }
      EXPECT_NEAR(
          small.channel(0)[size_t{20} * static_cast<size_t>(row) + static_cast<size_t>(column)],
          sum / 800, 1e-4);
    }
  }
  EXPECT_THROW(ReadExrAveraged(folder / "a.exr", {"c"}, 20, 3), UserError);
}

TEST(PngRows, HaveTheSameBytesHoweverTheyAreCut) {
  const test::TemporaryFolder folder;
  for (const int bits : {8, 16}) {
    const Image image = Waves(33, 150, {"R", "G", "B"});
    const PngTags tags{PngTransfer::kSrgb, 4000};
    WritePng(folder / "whole.png", image, bits, tags);
    EXPECT_EQ(EncodePng(image, bits, tags), ReadTextFile(folder / "whole.png"));
    for (const int at_once : {1, 64}) {
      PngWriter writer(folder / "rows.png", 33, 150, 3, bits, tags);
      WriteByRows(image, at_once, &writer);
      EXPECT_EQ(ReadTextFile(folder / "rows.png"), ReadTextFile(folder / "whole.png")) << at_once;
    }
  }
}

TEST(PngRows, AreReadAsTheyWereWritten) {
  const test::TemporaryFolder folder;
  const Image image = Waves(33, 15, {"R", "G", "B"});
  WritePng(folder / "a.png", image);
  const Image read = ReadPng(folder / "a.png");
  ASSERT_EQ(read.width, 33);
  ASSERT_EQ(read.height, 15);
  for (size_t i = 0; i < image.samples.size(); ++i) {
    EXPECT_NEAR(read.samples[i], image.samples[i], 0.5 / 255 + 1e-6);
  }
}

TEST(PngRows, OfAFileThatIsCutAreRefusedByName) {
  const test::TemporaryFolder folder;
  WritePng(folder / "a.png", Waves(64, 64, {"R", "G", "B"}));
  const std::string whole = ReadTextFile(folder / "a.png");
  for (const size_t size : {size_t{10}, size_t{40}, whole.size() / 2}) {
    WriteFileAtomically(folder / "a.png", whole.substr(0, size));
    EXPECT_THAT(test::MessageOf<UserError>([&] { ReadPng(folder / "a.png"); }),
                ::testing::AllOf(HasSubstr("a.png: "), HasSubstr("damaged")))
        << size;
  }
}

TEST(ImageHeaders, AreThoseOfTheirImages) {
  const test::TemporaryFolder folder;
  WriteExr(folder / "a.exr", Image(7, 5, {"normal.X", "B", "G", "R"}));
  const ImageHeader exr = ReadExrHeader(folder / "a.exr");
  EXPECT_EQ(exr.width, 7);
  EXPECT_EQ(exr.height, 5);
  EXPECT_EQ(exr.channels, (std::vector<std::string>{"R", "G", "B", "normal.X"}));
  WriteFileAtomically(folder / "a.png", std::string(64, 'x'));
  EXPECT_THROW(ReadPngHeader(folder / "a.png"), UserError);
  for (const auto& channels :
       {std::vector<std::string>{"Y"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}) {
    for (const int bits : {8, 16}) {
      WritePng(folder / "a.png", Image(300, 5, channels), bits);
      const ImageHeader png = ReadPngHeader(folder / "a.png");
      EXPECT_EQ(png.width, 300);
      EXPECT_EQ(png.height, 5);
      EXPECT_EQ(png.channels, channels);
      EXPECT_EQ(ReadImageHeader(folder / "a.png").channels, channels);
    }
  }
}

// A disk that fills up, as a limit on file sizes plays it.
TEST(ExrRows, ThatDoNotFitAreAnErrorAndNotAPartOfAFile) {
  const test::TemporaryFolder folder;
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{20 << 10, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(WriteExr(folder / "large.exr", Waves(256, 256, {"R", "G", "B"})), EnvironmentError);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(std::filesystem::exists(folder / "large.exr"));
}

}  // namespace
}  // namespace glint
