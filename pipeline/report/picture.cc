#include "pipeline/report/picture.h"

#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "base/errors/errors.h"
#include "base/resampling/resampling.h"
#include "pipeline/report/html.h"

namespace glint {
namespace {

// Interleaved, of three channels or one.
std::vector<unsigned char> Bytes(const Image& image, size_t channels) {
  std::vector<unsigned char> bytes(channels * image.pixels());
  for (size_t c = 0; c < channels; ++c) {
    const auto plane = image.channel(static_cast<int>(c));
    for (size_t i = 0; i < plane.size(); ++i) {
      const float clamped = std::isfinite(plane[i]) ? std::clamp(plane[i], 0.0f, 1.0f) : 0.0f;
      bytes[i * channels + c] = static_cast<unsigned char>(std::lround(255 * clamped));
    }
  }
  return bytes;
}

std::string DataUri(const std::string& type, const std::string& bytes) {
  return "data:image/" + type + ";base64," + Base64(bytes);
}

void ShrinkPlane(std::span<const float> plane, int width, int height, int channel, Image* small) {
  const cv::Mat from(height, width, CV_32F, const_cast<float*>(plane.data()));
  cv::Mat to(small->height, small->width, CV_32F, small->channel(channel).data());
  cv::resize(from, to, to.size(), 0, 0, cv::INTER_AREA);
}

}  // namespace

Image Shrunk(const Image& image, int largest_side) {
  const auto [width, height] = SizeAtMost(image.width, image.height, largest_side);
  if (width == image.width && height == image.height) return image;
  Image small(width, height, image.channels);
  for (int c = 0; c < static_cast<int>(image.channels.size()); ++c) {
    ShrinkPlane(image.channel(c), image.width, image.height, c, &small);
  }
  return small;
}

Image ShrunkPlanes(std::span<const float> rgb_planar, int width, int height, int largest_side) {
  const auto [small_width, small_height] = SizeAtMost(width, height, largest_side);
  Image small(small_width, small_height, {"R", "G", "B"});
  const size_t texels = static_cast<size_t>(width) * static_cast<size_t>(height);
  for (int c = 0; c < 3; ++c) {
    ShrinkPlane(rgb_planar.subspan(static_cast<size_t>(c) * texels, texels), width, height, c,
                &small);
  }
  return small;
}

std::string JpegBytes(const Image& image, int quality) {
  const bool coloured = image.channels.size() >= 3;
  const std::vector<unsigned char> samples = Bytes(image, coloured ? 3 : 1);
  const std::unique_ptr<void, decltype(&tjDestroy)> encoder(tjInitCompress(), &tjDestroy);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;  // NOLINT(google-runtime-int): TurboJPEG's
  const bool well =
      encoder && tjCompress2(encoder.get(), samples.data(), image.width, 0, image.height,
                             coloured ? TJPF_RGB : TJPF_GRAY, &bytes, &size,
                             coloured ? TJSAMP_420 : TJSAMP_GRAY, quality, TJFLAG_ACCURATEDCT) == 0;
  const std::unique_ptr<unsigned char, decltype(&tjFree)> held(bytes, &tjFree);
  if (!well) throw ComputationError("report: a picture cannot be encoded as JPEG");
  return {reinterpret_cast<const char*>(bytes), size};
}

std::string JpegUri(const Image& image, int quality) {
  return DataUri("jpeg", JpegBytes(image, quality));
}

std::string PngUri(const Image& image) { return DataUri("png", EncodePng(image)); }

std::string ImageHtml(const std::string& uri, const std::string& alternative) {
  return "<img src=\"" + uri + "\" alt=\"" + HtmlText(alternative) + "\">";
}

Image DisplayImage(std::span<const float> rgb_planar, int width, int height, float gain) {
  Image image(width, height, {"R", "G", "B"});
  std::transform(rgb_planar.begin(), rgb_planar.end(), image.samples.begin(),
                 [gain](float v) { return std::pow(std::clamp(gain * v, 0.0f, 1.0f), 1 / 2.2f); });
  return image;
}

Image ColorMapped(std::span<const float> values, int width, int height, float low, float high) {
  // Nine points of viridis (matplotlib), linear between them.
  constexpr std::array<std::array<float, 3>, 9> kViridis = {{{0.267f, 0.005f, 0.329f},
                                                             {0.279f, 0.175f, 0.483f},
                                                             {0.230f, 0.322f, 0.546f},
                                                             {0.173f, 0.449f, 0.558f},
                                                             {0.128f, 0.567f, 0.551f},
                                                             {0.158f, 0.684f, 0.502f},
                                                             {0.369f, 0.789f, 0.383f},
                                                             {0.678f, 0.864f, 0.190f},
                                                             {0.993f, 0.906f, 0.144f}}};
  Image image(width, height, {"R", "G", "B"});
  for (size_t i = 0; i < image.pixels(); ++i) {
    const float share =
        high > low ? std::clamp((values[i] - low) / (high - low), 0.0f, 1.0f) : 0.0f;
    const float place = (std::isfinite(share) ? share : 0.0f) * (kViridis.size() - 1);
    const size_t index = std::min(static_cast<size_t>(place), kViridis.size() - 2);
    const float part = place - static_cast<float>(index);
    for (size_t c = 0; c < 3; ++c) {
      image.channel(static_cast<int>(c))[i] =
          kViridis[index][c] + part * (kViridis[index + 1][c] - kViridis[index][c]);
    }
  }
  return image;
}

}  // namespace glint
