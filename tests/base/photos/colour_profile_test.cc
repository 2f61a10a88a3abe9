#include "base/photos/colour_profile.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <lcms2.h>
#include <libheif/heif.h>
#include <webp/mux.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/colour/srgb.h"
#include "base/images/image_format.h"
#include "base/images/jpeg_segments.h"
#include "base/photos/photo.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

std::string Saved(cmsHPROFILE profile) {
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::string icc(size, '\0');
  cmsSaveProfileToMem(profile, icc.data(), &size);
  cmsCloseProfile(profile);
  return icc;
}

// Chromaticities of R, G, B and white. `gamma` 0: sRGB's curve.
std::string Profile(const double xy[4][2], double gamma) {
  const cmsCIExyY white{xy[3][0], xy[3][1], 1};
  const cmsCIExyYTRIPLE primaries{
      {xy[0][0], xy[0][1], 1}, {xy[1][0], xy[1][1], 1}, {xy[2][0], xy[2][1], 1}};
  const double srgb[] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  cmsToneCurve* curve =
      gamma > 0 ? cmsBuildGamma(nullptr, gamma) : cmsBuildParametricToneCurve(nullptr, 4, srgb);
  cmsToneCurve* curves[] = {curve, curve, curve};
  std::string icc = Saved(cmsCreateRGBProfile(&white, &primaries, curves));
  cmsFreeToneCurve(curve);
  return icc;
}

// null: no encoder is installed.
heif_encoder* EncoderOf(heif_compression_format format, heif_context* context) {
  heif_encoder* encoder = nullptr;
  const heif_error found = heif_context_get_encoder_for_format(context, format, &encoder);
  return found.code == heif_error_Ok ? encoder : nullptr;
}

constexpr double kP3[4][2] = {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}};
constexpr double kProPhoto[4][2] = {
    {0.7347, 0.2653}, {0.1596, 0.8404}, {0.0366, 0.0001}, {0.3457, 0.3585}};

TEST(ColourProfile, SrgbNeedsNothing) {
  const ColourProfile srgb = ReadColourProfile(Saved(cmsCreate_sRGBProfile()));
  EXPECT_FALSE(srgb.converts());
  EXPECT_FALSE(srgb.has_curve());
  EXPECT_EQ(srgb.ignored, "");
  EXPECT_EQ(ReadColourProfile({}).Description(), "sRGB (assumed)");
}

// Published matrices (CSS Color 4): Display P3 to sRGB.
TEST(ColourProfile, DisplayP3IsWiderThanRec709) {
  for (const ColourProfile& p3 :
       {ReadColourProfile(Profile(kP3, 0)), ProfileOfCodePoints(12, 13)}) {
    EXPECT_FALSE(p3.has_curve());
    const auto red = p3.rec709_from_rgb({1, 0, 0}), white = p3.rec709_from_rgb({1, 1, 1});
    EXPECT_NEAR(red[0], 1.2249, 2e-3);
    EXPECT_NEAR(red[1], -0.0421, 2e-3);
    EXPECT_NEAR(red[2], -0.0196, 2e-3);
    for (const float channel : white) EXPECT_NEAR(channel, 1, 1e-6);
  }
}

TEST(ColourProfile, CurvesThatAreNotSrgbsAreRead) {
  const ColourProfile pro_photo = ReadColourProfile(Profile(kProPhoto, 1.8));
  ASSERT_TRUE(pro_photo.has_curve());
  EXPECT_NEAR(pro_photo.curve[1][128], std::pow(128 / 255.0, 1.8), 2e-3);
  const auto white = pro_photo.rec709_from_rgb({1, 1, 1});
  for (const float channel : white) EXPECT_NEAR(channel, 1, 1e-6);
  EXPECT_NEAR(AdobeRgbProfile().curve[0][128], std::pow(128 / 255.0, 563.0 / 256), 1e-4);
}

// SMPTE ST 2084: 100 cd/m² is stored as 0.508, 1,000 as 0.752; Rec. ITU-R BT.2100 HLG: a twelfth
// of its peak as 0.5.
TEST(ColourProfile, HdrsTransferFunctionsAreKnownByTheirNumbers) {
  const ColourProfile pq = ProfileOfCodePoints(9, 16), hlg = ProfileOfCodePoints(9, 18);
  EXPECT_EQ(pq.name, "Rec. 2020, PQ");
  ASSERT_TRUE(pq.has_curve() && hlg.has_curve());
  EXPECT_EQ(pq.curve[0][0], 0);
  EXPECT_NEAR(pq.curve[1][130], 100 / 203.0, 0.02);  // 130/255 is 0.510
  EXPECT_NEAR(pq.curve[2][192], 1000 / 203.0, 0.1);  // 192/255 is 0.753
  EXPECT_NEAR(pq.curve[0][255], 10000 / 203.0, 1e-3);
  EXPECT_NEAR(hlg.curve[0][128] / hlg.curve[0][255], 1 / 12.0, 1e-3);
  EXPECT_TRUE(pq.converts());
  const ColourProfile linear = ProfileOfCodePoints(1, 8);
  EXPECT_FALSE(linear.converts());
  EXPECT_FLOAT_EQ(linear.curve[0][100], 100 / 255.0f);
  EXPECT_FALSE(ProfileOfCodePoints(1, 13).has_curve());
  EXPECT_EQ(ProfileOfCodePoints(2, 2).name, "");
}

TEST(ColourProfile, AGammaOtherThanTheUsualIsACurve) {
  EXPECT_FALSE(ProfileOfGamma(0.45455).has_curve());
  for (const double nonsense : {0.0, -1.0, 1e9, std::nan("")}) {
    EXPECT_FALSE(ProfileOfGamma(nonsense).has_curve());
  }
  EXPECT_FLOAT_EQ(ProfileOfGamma(1).curve[2][51], 0.2f);
}

// ACEScg's published matrix to sRGB.
TEST(ColourProfile, ChromaticitiesAreOnesOwnPrimaries) {
  const ColourProfile aces =
      ProfileOfChromaticities({.713f, .293f, .165f, .830f, .128f, .044f, .32168f, .33767f});
  const auto red = aces.rec709_from_rgb({1, 0, 0});
  EXPECT_NEAR(red[0], 1.705, 5e-3);
  EXPECT_NEAR(red[1], -0.130, 5e-3);
  EXPECT_NEAR(red[2], -0.024, 5e-3);
  EXPECT_EQ(ProfileOfChromaticities({.64f, .33f, .30f, .60f, .15f, .06f, .3127f, .3290f}).name, "");
  EXPECT_EQ(ProfileOfChromaticities({}).name, "");
  EXPECT_EQ(ProfileOfChromaticities({.3f, .3f, .3f, .3f, .3f, .3f, .3f, .3f}).name, "");
}

TEST(ColourProfile, WhatIsNotThreePrimariesIsNamed) {
  const ColourProfile grey =
      ReadColourProfile(Saved(cmsCreateGrayProfile(cmsD50_xyY(), cmsBuildGamma(nullptr, 2.2))));
  EXPECT_EQ(grey.ignored, "not an RGB profile");
  EXPECT_FALSE(grey.converts());
  // Damaged ones never do more than that.
  const std::string icc = Profile(kP3, 0);
  for (size_t size = 1; size < icc.size(); size += 7) {
    EXPECT_FALSE(ReadColourProfile(icc.substr(0, size)).name.empty());
  }
  for (size_t i = 128; i < icc.size(); ++i) {
    std::string damaged = icc;
    damaged[i] = static_cast<char>(damaged[i] ^ 0xFF);
    const ColourProfile found = ReadColourProfile(damaged);
    for (const float value : found.rec709_from_rgb.of) EXPECT_TRUE(std::isfinite(value));
  }
}

// Its marker and length.
std::string Segment(unsigned marker, const std::string& content) {
  const size_t length = content.size() + 2;
  return {'\xFF', static_cast<char>(marker), static_cast<char>(length >> 8),
          static_cast<char>(length & 0xFF)};
}

TEST(IccOfJpeg, PartsAreJoinedByTheirNumbers) {
  using namespace std::string_literals;
  const auto part = [](int number, int count, const std::string& bytes) {
    const std::string content =
        "ICC_PROFILE\0"s + static_cast<char>(number) + static_cast<char>(count) + bytes;
    return Segment(0xE2, content) + content;
  };
  const std::string begin = "\xFF\xD8"s, end = "\xFF\xDA"s + "\0\x0C"s;
  EXPECT_EQ(IccOfJpeg(begin + part(2, 2, "second") + part(1, 2, "first") + end), "firstsecond");
  EXPECT_EQ(IccOfJpeg(begin + part(1, 2, "first") + end), "");  // one is missing
  EXPECT_EQ(IccOfJpeg(begin + end), "");
  EXPECT_EQ(IccOfJpeg(begin + part(1, 1, "cut off").substr(0, 14)), "");
}

class PhotoColours : public ::testing::Test {
 protected:
  // A grey picture with the profile embedded.
  fs::path Write(const std::string& name, const OIIO::TypeDesc& type, const std::string& icc) {
    fs::path file = folder_ / name;
    OIIO::ImageSpec spec(32, 32, 3, type);
    spec.attribute("ICCProfile",
                   OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(icc.size())), icc.data());
    const auto output = OIIO::ImageOutput::create(file.string());
    const std::vector<float> samples(32 * 32 * 3, 0.5f);
    EXPECT_TRUE(output->open(file.string(), spec));
    EXPECT_TRUE(output->write_image(OIIO::TypeFloat, samples.data()));
    output->close();
    return file;
  }
  test::TemporaryFolder folder_;
};

TEST_F(PhotoColours, AreReadFromEachFormat) {
  const std::string icc = Profile(kP3, 0);
  const ColourProfile wanted = ReadColourProfile(icc);
  ASSERT_TRUE(wanted.converts());
  for (const auto& [name, type] : {std::pair{"a.jpg", OIIO::TypeUInt8},
                                   {"a.png", OIIO::TypeUInt16},
                                   {"a.tif", OIIO::TypeUInt16}}) {
    const Photo photo = ReadPhoto(Write(name, type, icc));
    EXPECT_EQ(photo.colour.rec709_from_rgb, wanted.rec709_from_rgb) << name;
  }
}

// Fields that PNG and EXR have for it.
TEST_F(PhotoColours, AreReadWhereThereIsNoProfile) {
  const auto write = [&](const std::string& name, const OIIO::TypeDesc& type,
                         const std::function<void(OIIO::ImageSpec*)>& say) {
    const fs::path file = folder_ / name;
    OIIO::ImageSpec spec(32, 32, 3, type);
    say(&spec);
    const auto output = OIIO::ImageOutput::create(file.string());
    const std::vector<float> samples(32 * 32 * 3, 0.5f);
    EXPECT_TRUE(output->open(file.string(), spec));
    EXPECT_TRUE(output->write_image(OIIO::TypeFloat, samples.data()));
    output->close();
    return ReadPhoto(file).colour;
  };
  const ColourProfile linear = write("linear.png", OIIO::TypeUInt16, [](OIIO::ImageSpec* spec) {
    spec->attribute("oiio:ColorSpace", "linear");  // gAMA of 1
  });
  ASSERT_TRUE(linear.has_curve());
  EXPECT_FLOAT_EQ(linear.curve[0][51], 0.2f);
  const float aces[] = {.713f, .293f, .165f, .830f, .128f, .044f, .32168f, .33767f};
  const auto say = [&](OIIO::ImageSpec* spec) {
    spec->attribute("chromaticities", OIIO::TypeDesc("float[8]"), aces);
  };
  EXPECT_TRUE(write("aces.exr", OIIO::TypeHalf, say).converts());
  EXPECT_FALSE(write("usual.exr", OIIO::TypeHalf, [](OIIO::ImageSpec*) {}).converts());
}

TEST_F(PhotoColours, AndExifAreReadFromWebp) {
  const fs::path plain = folder_ / "plain.webp", file = folder_ / "a.webp";
  const auto output = OIIO::ImageOutput::create(plain.string());
  ASSERT_TRUE(output) << OIIO::geterror();
  const std::vector<std::uint8_t> samples(48 * 32 * 3, 128);
  ASSERT_TRUE(output->open(plain.string(), OIIO::ImageSpec(48, 32, 3, OIIO::TypeUInt8)));
  ASSERT_TRUE(output->write_image(OIIO::TypeUInt8, samples.data()));
  output->close();
  const std::string bytes = test::ReadAll(plain), icc = Profile(kP3, 0);
  // Two tags: the make, and a quarter turn.
  const unsigned char exif[] = {'I', 'I', 42, 0, 8, 0,   0,   0,   2, 0,    0x0F, 1, 2,
                                0,   4,   0,  0, 0, 'A', 'b', 'c', 0, 0x12, 1,    3, 0,
                                1,   0,   0,  0, 6, 0,   0,   0,   0, 0,    0,    0};
  const auto data = [](const void* from, std::size_t size) {
    return WebPData{static_cast<const std::uint8_t*>(from), size};
  };
  const WebPData whole = data(bytes.data(), bytes.size());
  WebPMux* mux = WebPMuxCreate(&whole, 1);
  ASSERT_NE(mux, nullptr);
  const WebPData profile = data(icc.data(), icc.size()), block = data(exif, sizeof exif);
  ASSERT_EQ(WebPMuxSetChunk(mux, "ICCP", &profile, 1), WEBP_MUX_OK);
  ASSERT_EQ(WebPMuxSetChunk(mux, "EXIF", &block, 1), WEBP_MUX_OK);
  WebPData assembled{nullptr, 0};
  ASSERT_EQ(WebPMuxAssemble(mux, &assembled), WEBP_MUX_OK);
  test::WriteAll(file, {reinterpret_cast<const char*>(assembled.bytes), assembled.size});
  WebPDataClear(&assembled);
  WebPMuxDelete(mux);

  const Photo photo = ReadPhoto(file);
  EXPECT_EQ(photo.format, "webp");
  EXPECT_EQ(photo.colour.rec709_from_rgb, ReadColourProfile(icc).rec709_from_rgb);
  EXPECT_EQ(photo.camera_model, "Abc");
  EXPECT_EQ(photo.orientation, 6);
  EXPECT_EQ(photo.image.width, 32);  // upright
  EXPECT_EQ(PhotoSize(file), (std::pair{32, 48}));
  EXPECT_TRUE(IsPhotoFileName("a.webp"));
}

TEST_F(PhotoColours, AvifIsRead) {
  const fs::path file = folder_ / "a.avif";
  heif_context* context = heif_context_alloc();
  heif_encoder* encoder = EncoderOf(heif_compression_AV1, context);
  ASSERT_NE(encoder, nullptr) << "install libheif-plugin-aomenc";
  heif_image* image = nullptr;
  heif_image_create(64, 48, heif_colorspace_RGB, heif_chroma_interleaved_RGB, &image);
  heif_image_add_plane(image, heif_channel_interleaved, 64, 48, 8);
  ASSERT_EQ(heif_context_encode_image(context, image, encoder, nullptr, nullptr).code,
            heif_error_Ok);
  ASSERT_EQ(heif_context_write_to_file(context, file.c_str()).code, heif_error_Ok);
  heif_image_release(image);
  heif_encoder_release(encoder);
  heif_context_free(context);
  const Photo photo = ReadPhoto(file);
  EXPECT_EQ(photo.image.width, 64);
  EXPECT_TRUE(IsPhotoFileName("a.AVIF"));
}

// irot and imir as libheif writes them for EXIF's eight orientations.
TEST_F(PhotoColours, TurnsOfAvifAreExifs) {
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const fs::path file = folder_ / ("turned" + std::to_string(orientation) + ".avif");
    heif_context* context = heif_context_alloc();
    heif_encoder* encoder = EncoderOf(heif_compression_AV1, context);
    ASSERT_NE(encoder, nullptr) << "install libheif-plugin-aomenc";
    heif_image* image = nullptr;
    heif_image_create(64, 48, heif_colorspace_RGB, heif_chroma_interleaved_RGB, &image);
    heif_image_add_plane(image, heif_channel_interleaved, 64, 48, 8);
    heif_encoding_options* options = heif_encoding_options_alloc();
    options->image_orientation = static_cast<heif_orientation>(orientation);
    ASSERT_EQ(heif_context_encode_image(context, image, encoder, options, nullptr).code,
              heif_error_Ok);
    ASSERT_EQ(heif_context_write_to_file(context, file.c_str()).code, heif_error_Ok);
    heif_encoding_options_free(options);
    heif_image_release(image);
    heif_encoder_release(encoder);
    heif_context_free(context);
    const Photo photo = ReadPhoto(file);
    EXPECT_EQ(photo.orientation, orientation);
    EXPECT_EQ(photo.image.width, orientation < 5 ? 64 : 48) << orientation;
  }
}

TEST_F(PhotoColours, GreyPicturesAreKnown) {
  const fs::path file = folder_ / "grey.jpg";
  const auto output = OIIO::ImageOutput::create(file.string());
  const std::vector<std::uint8_t> samples(32 * 32, 128);
  ASSERT_TRUE(output->open(file.string(), OIIO::ImageSpec(32, 32, 1, OIIO::TypeUInt8)));
  ASSERT_TRUE(output->write_image(OIIO::TypeUInt8, samples.data()));
  output->close();
  EXPECT_TRUE(ReadPhoto(file).grey);
  EXPECT_FALSE(ReadPhoto(Write("colour.jpg", OIIO::TypeUInt8, Profile(kP3, 0))).grey);
}

// EXIF of which the TIFF header follows its offset at once, as libheif writes it.
TEST_F(PhotoColours, AndExifAreReadFromHeic) {
  const fs::path file = folder_ / "a.heic";
  heif_context* context = heif_context_alloc();
  heif_encoder* encoder = EncoderOf(heif_compression_HEVC, context);
  ASSERT_NE(encoder, nullptr) << "install libheif-plugin-x265";
  heif_image* image = nullptr;
  heif_image_create(64, 64, heif_colorspace_RGB, heif_chroma_interleaved_RGB, &image);
  heif_image_add_plane(image, heif_channel_interleaved, 64, 64, 8);
  const std::string icc = Profile(kP3, 0);
  heif_image_set_raw_color_profile(image, "prof", icc.data(), icc.size());
  heif_image_handle* handle = nullptr;
  ASSERT_EQ(heif_context_encode_image(context, image, encoder, nullptr, &handle).code,
            heif_error_Ok);
  // One tag: the make.
  const unsigned char exif[] = {'I', 'I', 42, 0, 8, 0,   0,   0,   1, 0, 0x0F, 1, 2,
                                0,   4,   0,  0, 0, 'A', 'b', 'c', 0, 0, 0,    0, 0};
  heif_context_add_exif_metadata(context, handle, exif, sizeof exif);
  ASSERT_EQ(heif_context_write_to_file(context, file.c_str()).code, heif_error_Ok);
  heif_image_handle_release(handle);
  heif_image_release(image);
  heif_encoder_release(encoder);
  heif_context_free(context);

  const Photo photo = ReadPhoto(file);
  EXPECT_TRUE(photo.colour.converts());
  EXPECT_EQ(photo.colour.rec709_from_rgb, ReadColourProfile(icc).rec709_from_rgb);
  EXPECT_EQ(photo.camera_model, "Abc");
}

}  // namespace
}  // namespace glint
