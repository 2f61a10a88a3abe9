#include "rectify/resample/resample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "rectify/resample/footprint.h"
#include "tests/rectify/plane_photo.h"

namespace glint {
namespace {

SamplePlane Plane(int texels, double size_mm) {
  SamplePlane plane;
  plane.width = plane.height = texels;
  plane.width_mm = plane.height_mm = size_mm;
  return plane;
}

// A picture that is a top view already, one pixel a texel.
ResampledView OneToOne(const LinearPhoto& photo, FilterKind filter) {
  const SamplePlane plane = Plane(photo.width(), 1.0);
  ResampleOptions options;
  options.filter = filter;
  return ResampleToPlane(photo, TopViewProjection(plane, photo.width(), photo.height()), plane,
                         options);
}

// Values of 8 bits.
Image NoiseImage(int side, unsigned seed) {
  std::mt19937 random(seed);
  Image image = FlatImage(side, side, 0);
  for (float& sample : image.samples) sample = static_cast<float>(random() % 245) / 255.0f;
  return image;
}

TEST(Resample, ConstantsStayConstants) {
  for (const FilterKind filter : {FilterKind::kSharp, FilterKind::kSoft, FilterKind::kLanczos}) {
    for (const int bits : {8, 16, 32}) {
      for (const double tilt : {0.0, 45.0}) {
        const LinearPhoto photo(FlatPhoto(400, 400, 128 / 255.0f, bits), Encoding::kLinear);
        const CameraProjection projection(TestCamera(400, 420, -0.05, 0.01),
                                          LookAtSample(100, tilt, 20));
        ResampleOptions options;
        options.filter = filter;
        const ResampledView view = ResampleToPlane(photo, projection, Plane(64, 50), options);
        for (size_t i = 0; i < view.status.size(); ++i) {
          ASSERT_EQ(view.status[i], TexelStatus::kUsable);
          ASSERT_NEAR(view.rgb[i], 128 / 255.0f, 2e-5);
        }
      }
    }
  }
}

// A white wall through a lens that darkens the corners is white again; 8-bit photos keep 1 as their
// ceiling, and clipped texels what they showed.
TEST(Resample, DividesTheLensesFalloffOut) {
  Camera camera = TestCamera(400, 420, -0.05, 0.01);
  camera.vignetting = {-0.5, 0.12, -0.03};
  const CameraProjection projection(camera, LookAtSample(100, 20, 20));
  ResampleOptions options;
  options.vignetting = camera;
  for (const float wall : {0.6f, 1.5f}) {
    Image image = FlatImage(400, 400, 0);
    for (size_t i = 0; i < image.samples.size(); ++i) {
      const size_t pixel = i % image.pixels(), column = pixel % 400, row = pixel / 400;
      image.samples[i] =
          static_cast<float>(wall * Vignetting(camera, {static_cast<double>(column) + 0.5,
                                                        static_cast<double>(row) + 0.5}));
    }
    const ResampledView view = ResampleToPlane(LinearPhoto(PhotoOf(image, 32), Encoding::kLinear),
                                               projection, Plane(64, 50), options);
    for (const float value : view.rgb) ASSERT_NEAR(value, wall, 2e-4);
  }
  const LinearPhoto dark(FlatPhoto(400, 400, 250 / 255.0f, 8), Encoding::kLinear);
  const ResampledView bright = ResampleToPlane(dark, projection, Plane(64, 50), options);
  EXPECT_EQ(*std::max_element(bright.rgb.begin(), bright.rgb.end()), 1.0f);
  const LinearPhoto clipped(FlatPhoto(400, 400, 254 / 255.0f, 8), Encoding::kLinear);
  const ResampledView view = ResampleToPlane(clipped, projection, Plane(64, 50), options);
  EXPECT_EQ(view.status[0], TexelStatus::kSaturated);
  for (const float value : view.rgb) ASSERT_NEAR(value, 254 / 255.0f, 2e-5);
}

TEST(Resample, MultipliesChannelsByTheirGainsButNotWhatClips) {
  const CameraProjection projection(TestCamera(400, 420, 0, 0), LookAtSample(100, 20, 20));
  ResampleOptions options;
  options.gain_rgb = {1.1, 1.0, 0.9};
  const LinearPhoto photo(FlatPhoto(400, 400, 102 / 255.0f, 8), Encoding::kLinear);
  const ResampledView view = ResampleToPlane(photo, projection, Plane(64, 50), options);
  const size_t texels = view.rgb.size() / 3;
  for (size_t i = 0; i < view.rgb.size(); ++i) {
    ASSERT_NEAR(view.rgb[i], options.gain_rgb[i / texels] * 102 / 255, 2e-5);
  }
  const LinearPhoto clipped(FlatPhoto(400, 400, 254 / 255.0f, 8), Encoding::kLinear);
  for (const float value : ResampleToPlane(clipped, projection, Plane(64, 50), options).rgb) {
    ASSERT_NEAR(value, 254 / 255.0f, 2e-5);
  }
}

// What a chart told of the camera: applied to what does not clip, before colours beyond Rec.709 end
// at 0; 8-bit photos keep 1 as their ceiling.
TEST(Resample, CorrectsColoursButNotWhatClips) {
  const CameraProjection projection(TestCamera(400, 420, 0, 0), LookAtSample(100, 20, 20));
  ResampleOptions options;
  options.gain_rgb = {1, 1, 0.5};
  options.colour.emplace();
  options.colour->matrix.leftCols<3>() << 1.5, -0.5, 0, 0.2, 0.8, 0, 0.1, -0.5, 0.4;
  const float wall = 102 / 255.0f;
  const LinearPhoto photo(FlatPhoto(400, 400, wall, 8), Encoding::kLinear);
  const ResampledView view = ResampleToPlane(photo, projection, Plane(64, 50), options);
  const size_t texels = view.rgb.size() / 3;
  for (size_t i = 0; i < texels; ++i) {
    ASSERT_EQ(view.status[i], TexelStatus::kUsable);
    ASSERT_NEAR(view.rgb[i], wall, 2e-5);
    ASSERT_NEAR(view.rgb[texels + i], wall, 2e-5);
    ASSERT_EQ(view.rgb[2 * texels + i], 0);
  }
  const LinearPhoto clipped(FlatPhoto(400, 400, 254 / 255.0f, 8), Encoding::kLinear);
  const ResampledView white = ResampleToPlane(clipped, projection, Plane(64, 50), options);
  for (const TexelStatus status : white.status) ASSERT_EQ(status, TexelStatus::kSaturated);
  for (const float value : white.rgb) ASSERT_NEAR(value, 254 / 255.0f, 2e-5);
  options.colour->matrix *= 4;
  const ResampledView bright = ResampleToPlane(photo, projection, Plane(64, 50), options);
  EXPECT_EQ(*std::max_element(bright.rgb.begin(), bright.rgb.end()), 1.0f);
}

// Centres of mass of Gaussian blobs come out where they were painted, to a tenth of a texel, under
// lens distortion, tilt and roll.
TEST(Resample, BlobsLandWhereTheyWerePainted) {
  const double size_mm = 60, sigma_mm = 1.2, pitch_mm = 12;
  const auto radiance = [&](double x, double y) {
    const double dx = x - pitch_mm * std::round(x / pitch_mm);
    const double dy = y - pitch_mm * std::round(y / pitch_mm);
    return std::exp(-(dx * dx + dy * dy) / (2 * sigma_mm * sigma_mm));
  };
  const Camera camera = TestCamera(480, 510, -0.12, 0.03);
  for (const double tilt : {0.0, -40.0}) {
    const Rigid3 pose = LookAtSample(100, tilt, 15);
    const LinearPhoto photo(PhotographPlane(camera, pose, radiance, 1), Encoding::kLinear);
    for (const int texels : {96, 400}) {
      const SamplePlane plane = Plane(texels, size_mm);
      const ResampledView view = ResampleToPlane(photo, CameraProjection(camera, pose), plane, {});
      const double texel_mm = size_mm / texels;
      for (int j = -2; j <= 2; ++j) {
        for (int i = -2; i <= 2; ++i) {
          double mass = 0, mx = 0, my = 0;
          for (int row = 0; row < texels; ++row) {
            for (int column = 0; column < texels; ++column) {
              const double x = plane.x_mm(column) - i * pitch_mm,
                           y = plane.y_mm(row) - j * pitch_mm;
              if (x * x + y * y > 16 * sigma_mm * sigma_mm) continue;
              const double value = view.rgb[static_cast<size_t>(row) * texels + column];
              mass += value;
              mx += value * x;
              my += value * y;
            }
          }
          EXPECT_NEAR(mx / mass / texel_mm, 0, 0.1) << "tilt " << tilt << " blob " << i << "," << j;
          EXPECT_NEAR(my / mass / texel_mm, 0, 0.1) << "tilt " << tilt << " blob " << i << "," << j;
        }
      }
    }
  }
}

// Contrast that a sine wave keeps at 1:1, by its frequency in cycles per texel.
double ContrastAtOneToOne(double frequency, FilterKind filter) {
  const int side = 128;
  Image image = FlatImage(side, side, 0);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      image.channel(0)[static_cast<size_t>(y) * side + x] =
          static_cast<float>(0.5 + 0.4 * std::cos(2 * std::numbers::pi * frequency * x));
    }
  }
  const ResampledView view = OneToOne(LinearPhoto(PhotoOf(image, 32), Encoding::kLinear), filter);
  double re = 0, im = 0;
  const size_t row = 64 * side;
  for (int x = 14; x < 114; ++x) {
    const double phase = 2 * std::numbers::pi * frequency * x;
    re += (view.rgb[row + x] - 0.5) * std::cos(phase);
    im += (view.rgb[row + x] - 0.5) * std::sin(phase);
  }
  return std::hypot(re, im) / 100 * 2 / 0.4;
}

TEST(Resample, StaysSharpAtOneToOne) {
  EXPECT_GT(ContrastAtOneToOne(0.10, FilterKind::kSharp), 0.98);
  EXPECT_GT(ContrastAtOneToOne(0.25, FilterKind::kSharp), 0.95);
  EXPECT_GT(ContrastAtOneToOne(0.40, FilterKind::kSharp), 0.75);
  EXPECT_GT(ContrastAtOneToOne(0.25, FilterKind::kLanczos), 0.95);
  EXPECT_GT(ContrastAtOneToOne(0.25, FilterKind::kSoft), 0.88);
}

// The mean of black and white pixels is half the light, not the light of the mean code.
TEST(Resample, AveragesRadianceAndNotCodes) {
  Image image = FlatImage(256, 256, 0);
  for (size_t i = 0; i < image.samples.size(); ++i) {
    const size_t x = i % 256, y = i / 256 % 256;
    image.samples[i] = (x + y) % 2 == 0 ? 0.0f : 250 / 255.0f;
  }
  const float white = LinearFromEncoded(Encoding::kGamma22, 250 / 255.0f);
  const LinearPhoto linear(PhotoOf(image, 8), Encoding::kGamma22);
  const SamplePlane plane = Plane(64, 1);
  const ResampledView view = ResampleToPlane(linear, TopViewProjection(plane, 256, 256), plane, {});
  EXPECT_NEAR(view.rgb[32 * 64 + 32], white / 2, 0.005);
}

TEST(Resample, SameBytesForAnyNumberOfThreads) {
  const LinearPhoto photo(PhotoOf(NoiseImage(500, 7), 8), Encoding::kSrgb);
  const CameraProjection projection(TestCamera(500, 520, -0.1), LookAtSample(100, 35, 10));
  const SamplePlane plane = Plane(300, 70);
  ResampleOptions options;
  const ResampledView one = ResampleToPlane(photo, projection, plane, options);
  for (const int threads : {2, 3, 7}) {
    options.threads = threads;
    const ResampledView many = ResampleToPlane(photo, projection, plane, options);
    EXPECT_EQ(one.rgb, many.rgb);
    EXPECT_EQ(one.status, many.status);
  }
}

TEST(Resample, EightAndSixteenBitAndFloatStorageAgree) {
  const Image noise = NoiseImage(200, 3);
  const auto stored_with = [&](int bits) {
    return OneToOne(LinearPhoto(PhotoOf(noise, bits), Encoding::kGamma22), FilterKind::kSharp);
  };
  const ResampledView a = stored_with(8), b = stored_with(16), c = stored_with(32);
  for (size_t i = 0; i < a.rgb.size(); ++i) {
    ASSERT_NEAR(a.rgb[i], b.rgb[i], 1e-4);
    ASSERT_NEAR(a.rgb[i], c.rgb[i], 1e-6);
  }
}

// One clipped pixel rules out the texels whose kernel reaches it, and no other.
TEST(Resample, MasksWhatAClippedPixelTouches) {
  for (const int scale : {1, 4}) {
    const int side = 32 * scale;
    Image image = FlatImage(side, side, 0.25f);
    const int at = 16 * scale + scale / 2;
    image.channel(1)[static_cast<size_t>(at) * side + at] = 1.0f;
    const LinearPhoto linear(PhotoOf(image, 8), Encoding::kGamma22);
    const SamplePlane plane = Plane(32, 1);
    const ResampledView view =
        ResampleToPlane(linear, TopViewProjection(plane, side, side), plane, {});
    for (int row = 0; row < 32; ++row) {
      for (int column = 0; column < 32; ++column) {
        const double dx = (column + 0.5) - (at + 0.5) / scale;
        const double dy = (row + 0.5) - (at + 0.5) / scale;
        const double r = std::hypot(dx, dy);
        const TexelStatus status = view.status[static_cast<size_t>(row) * 32 + column];
        if (std::abs(r - 2) > 0.1) {
          EXPECT_EQ(status, r < 2 ? TexelStatus::kSaturated : TexelStatus::kUsable) << r;
        }
      }
    }
  }
}

// A whole picture, and a part of it that begins at a pixel.
TEST(Resample, PixelsThatAreTexelsStayAsTheyAre) {
  Image noise = NoiseImage(48, 5);
  noise.channel(1)[20 * 48 + 20] = 1.0f;
  const LinearPhoto photo(PhotoOf(noise, 8), Encoding::kGamma22);
  for (const int side : {48, 32}) {
    const SamplePlane plane = Plane(side, 1), whole = Plane(48, 48.0 / side);
    const HomographyProjection projection = TopViewProjection(whole, 48, 48);
    ASSERT_TRUE(TexelsArePixels(projection, plane));
    ResampleOptions options;
    options.pixels_as_they_are = true;
    const ResampledView view = ResampleToPlane(photo, projection, plane, options);
    const int margin = (48 - side) / 2;
    photo.Visit([&](const auto& pixels) {
      for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
          const size_t texel = static_cast<size_t>(row) * side + column;
          const auto pixel = pixels.At(static_cast<size_t>(row + margin) * 48 + column + margin);
          ASSERT_EQ(view.rgb[texel], pixel.rgb[0]);
          ASSERT_EQ(view.status[texel],
                    pixel.saturated ? TexelStatus::kSaturated : TexelStatus::kUsable);
        }
      }
    });
  }
}

TEST(Resample, PixelsAreNoTexelsWhereTheyLieBetweenThem) {
  const SamplePlane plane = Plane(32, 1);
  EXPECT_TRUE(TexelsArePixels(TopViewProjection(plane, 32, 32), plane));
  EXPECT_FALSE(TexelsArePixels(TopViewProjection(plane, 33, 33), plane));
  EXPECT_FALSE(TexelsArePixels(TopViewProjection(plane, 64, 64), plane));
  const HomographyProjection top = TopViewProjection(plane, 32, 32);
  Eigen::Matrix3d moved = Eigen::Matrix3d::Identity();
  moved(1, 2) = 0.5 / 32;
  EXPECT_FALSE(TexelsArePixels(MovedProjection(top, moved), plane));
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  turned.topLeftCorner<2, 2>() << 0, -1, 1, 0;
  EXPECT_FALSE(TexelsArePixels(MovedProjection(top, turned), plane));
}

TEST(Resample, FloatsClipOnlyWhereAsked) {
  const Photo bright = FlatPhoto(32, 32, 3.5f, 32);
  EXPECT_EQ(OneToOne(LinearPhoto(bright, Encoding::kLinear), FilterKind::kSharp).status[40],
            TexelStatus::kUsable);
  SaturationRule rule;
  rule.float_level = 1.0;
  const LinearPhoto clipped(bright, Encoding::kLinear, rule);
  EXPECT_EQ(OneToOne(clipped, FilterKind::kSharp).status[40], TexelStatus::kSaturated);
}

TEST(Resample, TexelsOutsideThePhotoAreOutside) {
  const LinearPhoto photo(FlatPhoto(100, 100, 0.5f, 8), Encoding::kLinear);
  const SamplePlane plane = Plane(40, 40);
  // One pixel a millimetre, the plane's centre at the photo's left edge.
  Eigen::Matrix3d half;
  half << 1, 0, 0, 0, -1, 50, 0, 0, 1;
  const ResampledView view = ResampleToPlane(photo, HomographyProjection(half), plane, {});
  for (int column = 0; column < 40; ++column) {
    EXPECT_EQ(view.status[20 * 40 + column],
              column < 20 ? TexelStatus::kOutside : TexelStatus::kUsable);
    EXPECT_EQ(view.rgb[20 * 40 + column] == 0, column < 20);
  }
}

TEST(Resample, NothingIsSeenFromBehindOrThroughAFoldedLens) {
  const LinearPhoto photo(FlatPhoto(200, 200, 0.5f, 8), Encoding::kLinear);
  const SamplePlane plane = Plane(32, 40);
  Rigid3 behind = LookAtSample(100, 0, 0);
  behind.rotation = Eigen::Matrix3d::Identity();  // sees the sample's back: mirrored
  for (const TexelStatus status :
       ResampleToPlane(photo, CameraProjection(TestCamera(200, 200), behind), plane, {}).status) {
    ASSERT_EQ(status, TexelStatus::kOutside);
  }
  behind.translation.z() = -100;
  for (const TexelStatus status :
       ResampleToPlane(photo, CameraProjection(TestCamera(200, 200), behind), plane, {}).status) {
    ASSERT_EQ(status, TexelStatus::kOutside);
  }
  // 1 + k1 r² with k1 = −5 turns back at r² = 1/15: texels beyond must not reappear mirrored.
  const CameraProjection folding(TestCamera(200, 200, -5), LookAtSample(50, 0, 0));
  const ResampledView view = ResampleToPlane(photo, folding, plane, {});
  for (int row = 0; row < 32; ++row) {
    for (int column = 0; column < 32; ++column) {
      const double r = std::hypot(plane.x_mm(column), plane.y_mm(row)) / 50;
      if (r * r > 1.05 / 15) {
        ASSERT_EQ(view.status[static_cast<size_t>(row) * 32 + column], TexelStatus::kOutside);
      }
    }
  }
}

// All four terms of a fisheye bend rays: without the last two this lens would fold at 55°.
TEST(CameraProjection, AFisheyeSeesAsFarAsAllItsTermsGrow) {
  Camera fisheye;
  fisheye.model = CameraModel::kOpenCvFisheye;
  fisheye.width_px = fisheye.height_px = 400;
  fisheye.parameters = {150, 150, 200, 200, 0.1, -0.3, 0.25, -0.05};
  const CameraProjection projection(fisheye, LookAtSample(50, 0, 0));
  double last_px = 0;
  for (const double degrees : {10.0, 30.0, 50.0, 60.0, 70.0}) {
    const double x_mm = 50 * std::tan(degrees * std::numbers::pi / 180);
    const auto seen = projection.ImageFromPlane(x_mm, 0);
    ASSERT_TRUE(seen) << degrees;
    const double off_px = (*seen - Eigen::Vector2d(200, 200)).norm();
    EXPECT_GT(off_px, last_px) << degrees;
    last_px = off_px;
  }
}

TEST(Resample, NegativeLobesNeverMakeNegativeLight) {
  Image image = FlatImage(64, 64, 0.0f);
  image.channel(0)[32 * 64 + 32] = 1000.0f;
  const LinearPhoto linear(PhotoOf(image, 32), Encoding::kLinear);
  for (const FilterKind filter : {FilterKind::kSharp, FilterKind::kLanczos}) {
    const ResampledView view = OneToOne(linear, filter);
    EXPECT_GE(*std::min_element(view.rgb.begin(), view.rgb.end()), 0.0f);
  }
}

TEST(Resample, MaskedTexelsArePassedOver) {
  const LinearPhoto photo(FlatPhoto(64, 64, 0.5f, 8), Encoding::kLinear);
  const SamplePlane plane = Plane(64, 1);
  std::vector<TexelStatus> before(64 * 64, TexelStatus::kOutside);
  before[100] = TexelStatus::kMasked;
  const ResampledView view =
      ResampleToPlane(photo, TopViewProjection(plane, 64, 64), plane, {}, before);
  EXPECT_EQ(view.status[100], TexelStatus::kMasked);
  EXPECT_EQ(view.rgb[100], 0);
  EXPECT_EQ(view.status[101], TexelStatus::kUsable);
}

TEST(Footprint, FollowsTheJacobian) {
  // Axes 6 and 2 pixels, turned by 30°.
  const double c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
  const Footprint f = FootprintFromJacobian({6 * c, -2 * s, 6 * s, 2 * c});
  const auto r2 = [&](double x, double y) { return f.xx * x * x + f.xy * x * y + f.yy * y * y; };
  EXPECT_NEAR(r2(6 * c, 6 * s), 1, 1e-12);
  EXPECT_NEAR(r2(-2 * s, 2 * c), 1, 1e-12);
  EXPECT_NEAR(f.variance_xx, 36 * c * c + 4 * s * s, 1e-12);
  // Finer than the pixels: a unit circle.
  const Footprint fine = FootprintFromJacobian({0.1, 0, 0, 0.3});
  EXPECT_NEAR(fine.xx, 1, 1e-12);
  EXPECT_NEAR(fine.xy, 0, 1e-12);
  EXPECT_NEAR(fine.yy, 1, 1e-12);
}

}  // namespace
}  // namespace glint
