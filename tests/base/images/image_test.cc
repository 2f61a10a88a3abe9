#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/images/image.h"
#include "tests/base/images/gradient_image.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using test::Gradient;

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

}  // namespace
}  // namespace glint
