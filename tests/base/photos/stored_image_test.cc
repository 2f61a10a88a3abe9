#include "base/photos/stored_image.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace glint {
namespace {

template <class T>
void ExpectEveryCodeBack(int bits) {
  constexpr int kMax = std::numeric_limits<T>::max();
  Image image((kMax + 1) / 16, 16, kRgbChannels);
  for (size_t i = 0; i < image.samples.size(); ++i) {
    image.samples[i] = StoredImage::ValueOf(static_cast<T>(i % image.pixels()));
  }
  const StoredImage stored = Stored(image, bits);
  EXPECT_EQ(stored.Planes().samples, image.samples);
  stored.Visit([&](const auto& samples) {
    EXPECT_EQ(sizeof samples[0], sizeof(T));
    for (size_t i = 0; i < image.pixels(); ++i) {
      for (size_t c = 0; c < 3; ++c) ASSERT_EQ(static_cast<size_t>(samples[3 * i + c]), i);
    }
  });
}

TEST(StoredImage, EveryCodeComesBackAsItWas) {
  ExpectEveryCodeBack<std::uint8_t>(8);
  ExpectEveryCodeBack<std::uint16_t>(16);
}

TEST(StoredImage, FloatsStayWhatTheyAre) {
  Image image(2, 1, kRgbChannels);
  image.samples = {0.1f, 7, -1, 0.5f, 1e-9f, 3e7f};
  const StoredImage stored = Stored(image, 32);
  EXPECT_EQ(stored.Planes().samples, image.samples);
  EXPECT_EQ(stored.at(1, 0), 7);
  EXPECT_EQ(stored.at(0, 2), 1e-9f);
}

TEST(StoredImage, ValuesBeyondTheCodesAreClamped) {
  Image image(1, 1, kRgbChannels);
  image.samples = {-0.5f, 2, 0.25f};
  EXPECT_EQ(Stored(image, 8).at(0, 0), 0);
  EXPECT_EQ(Stored(image, 16).at(0, 1), 1);
}

}  // namespace
}  // namespace glint
