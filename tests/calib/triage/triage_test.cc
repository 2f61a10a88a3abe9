// Bad photographs are named, with the measure that condemned them; good ones are not.
#include "calib/triage/triage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/calib/testing/synthetic_photo.h"

namespace glint {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::LookAt;

Photo PhotoOf(const GrayImage& gray) {
  Photo photo;
  photo.image = Stored(testing::RgbOf(gray), 8);
  photo.format = "jpeg";
  photo.camera_model = "Maker Phone";
  photo.exposure_time_s = 0.01;
  photo.iso = 100;
  photo.f_number = 1.8;
  photo.exif.flash = 9;
  return photo;
}

struct Look {
  double blur_px = 0.7, peak = 0.9;
  int pose = 0;
};

PhotoMeasures Take(const std::string& name, const Look& look) {
  testing::PhotoSettings settings;
  settings.samples = 2;
  settings.seed = static_cast<std::uint64_t>(look.pose) + 1;
  settings.blur_px = look.blur_px;
  settings.peak = look.peak;
  const Camera camera{CameraModel::kRadial, 640, 480, {560, 320, 240, 0, 0}};
  const GrayImage gray = Photograph(
      testing::SmallBoard(), camera,
      LookAt(230 + 5 * look.pose, 6 + 5 * look.pose, 70 * look.pose, 20 * look.pose), settings);
  const Photo photo = PhotoOf(gray);
  return MeasurePhoto(name, photo, gray, DetectBoard(gray, testing::SmallBoard()));
}

std::vector<std::string> Kinds(const std::vector<Remark>& remarks, const std::string& photo) {
  std::vector<std::string> kinds;
  for (const Remark& remark : remarks) {
    if (remark.photo == photo) kinds.emplace_back(RemarkName(remark.kind));
  }
  return kinds;
}

std::string TextsOf(const std::vector<Remark>& remarks) {
  std::string text;
  for (const Remark& remark : remarks) text += remark.photo + ": " + remark.text + "\n";
  return text;
}

TEST(Triage, NamesTheBlurredTheDarkTheBrightAndTheDuplicateAlone) {
  std::vector<PhotoMeasures> photos;
  for (int i = 0; i < 4; ++i) photos.push_back(Take("good" + std::to_string(i), {.pose = i}));
  photos.push_back(Take("blurred", {.blur_px = 1.8, .pose = 4}));
  photos.push_back(Take("dark", {.peak = 0.03, .pose = 5}));
  photos.push_back(Take("bright", {.peak = 4, .pose = 6}));
  photos.push_back(Take("again", {.pose = 2}));
  photos.push_back(Take("shaken", {.blur_px = 6, .pose = 5}));  // no corner is found
  const std::vector<Remark> remarks = Triage(photos);
  EXPECT_THAT(Kinds(remarks, "shaken"), ElementsAre("blurred"))
      << photos.back().edge_px << " against " << photos[0].edge_px;
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(Kinds(remarks, "good" + std::to_string(i)).empty()) << TextsOf(remarks);
  }
  EXPECT_THAT(Kinds(remarks, "blurred"), ElementsAre("blurred")) << TextsOf(remarks);
  EXPECT_THAT(Kinds(remarks, "dark"), ElementsAre("dark")) << TextsOf(remarks);
  EXPECT_THAT(Kinds(remarks, "bright"), ElementsAre("overexposed")) << TextsOf(remarks);
  EXPECT_THAT(Kinds(remarks, "again"), ElementsAre("duplicate")) << TextsOf(remarks);
  EXPECT_THAT(TextsOf(remarks), HasSubstr("shows the same as good2"));
}

// A camera's 12 bits in the lower ones of 16.
TEST(Triage, SamplesThatWereNotScaledTo16BitsAreNotCalledUnderexposed) {
  PhotoMeasures photo = Take("a", {.peak = 0.03});
  photo.file.bits = 16;
  photo.brightest = 3800 / 65535.0;
  const std::string text = TextsOf(Triage({photo}));
  EXPECT_THAT(text,
              HasSubstr("they seem to have 12 bits and were not scaled; multiply them by 16"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("expose more")));
  photo.brightest = 0.9;
  EXPECT_THAT(TextsOf(Triage({photo})), HasSubstr("expose more"));
}

TEST(Triage, BlurIsMeasuredInPixelsOfThePhoto) {
  for (const double blur : {0.7, 1.2, 1.7}) {
    // The pixel itself widens an edge by 0.29 px.
    EXPECT_NEAR(Take("a", {.blur_px = blur}).blur_px, std::hypot(blur, 0.29), 0.15 * blur);
  }
}

std::vector<PhotoMeasures> Good(int count) {
  std::vector<PhotoMeasures> photos(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    photos[i].name = "p" + std::to_string(i);
    photos[i].file = PhotoOf({});
    photos[i].file.image.width = 4000;
    photos[i].file.image.height = 3000;
    photos[i].file.exif.width_px = 4000;
    photos[i].file.exif.height_px = 3000;
  }
  return photos;
}

TEST(CheckExif, SaysNothingOfPhotographsInOrderUprightOnesToo) {
  auto photos = Good(3);
  photos[1].file.orientation = 6;
  std::swap(photos[1].file.image.width, photos[1].file.image.height);
  photos[2].file.exif.shutter_s = 1.0 / 97;
  photos[2].file.exif.aperture_f = 1.78;
  EXPECT_THAT(CheckExif(photos), ::testing::IsEmpty()) << TextsOf(CheckExif(photos));
}

TEST(CheckExif, NamesEveryContradiction) {
  const auto complaint = [](const std::function<void(PhotoMeasures*)>& spoil) {
    auto photos = Good(3);
    spoil(&photos[1]);
    return TextsOf(CheckExif(photos));
  };
  EXPECT_THAT(
      complaint([](PhotoMeasures* p) { p->file.exif.width_px = 5000; }),
      HasSubstr("p1: EXIF reports 5000x3000 pixels, the picture has 4000x3000: it was crop"));
  EXPECT_THAT(complaint([](PhotoMeasures* p) {
                p->file.exif.width_px = 8000;
                p->file.exif.height_px = 6000;
              }),
              HasSubstr("scaled"));
  EXPECT_THAT(complaint([](PhotoMeasures* p) { p->file.exif.focal_is_zero = true; }),
              HasSubstr("focal length of 0 mm"));
  EXPECT_THAT(complaint([](PhotoMeasures* p) { p->file.exif.shutter_s = 0.5; }),
              HasSubstr("exposure time of 0.01 s and a shutter speed of 0.5 s"));
  EXPECT_THAT(complaint([](PhotoMeasures* p) { p->file.exif.aperture_f = 4; }),
              HasSubstr("f-number of 1.8"));
  EXPECT_THAT(complaint([](PhotoMeasures* p) { p->file.exif.flash = 16; }),
              HasSubstr("did not fire"));
  EXPECT_THAT(complaint([](PhotoMeasures* p) { p->file.camera_model = "Other"; }),
              HasSubstr("several cameras in one capture: Maker Phone (p0, p2); Other (p1)"));
  EXPECT_THAT(complaint([](PhotoMeasures* p) { p->file.iso = 0; }), HasSubstr("p1 (no ISO)"));
  EXPECT_THAT(complaint([](PhotoMeasures* p) { p->file.orientation = 2; }),
              HasSubstr("mirrored picture"));
  EXPECT_THAT(complaint([](PhotoMeasures* p) { p->file.format = "raw"; }),
              HasSubstr("together with developed ones"));
}

}  // namespace
}  // namespace glint
