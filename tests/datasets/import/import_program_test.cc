// glint-import on small made-up sets, run as a person runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "base/errors/errors.h"
#include "base/files/json.h"
#include "base/formats/capture.h"
#include "base/formats/rectified_set.h"
#include "base/images/image.h"
#include "datasets/import/import_set.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr int kSide = 48;

class ImportProgram : public testing::Test {
 protected:
  fs::path source() const { return folder_.path() / "source"; }
  fs::path capture() const { return folder_.path() / "capture"; }
  fs::path views() const { return capture() / "glint" / "rectify"; }

  void SetUp() override {
    for (int i = 0; i < 3; ++i) WriteImage(i, kSide, kSide);
  }

  // Brightness grows with the row (down) and the column's sixteenth; image i is darker than i − 1.
  static float Stored(int i, int row, int column) {
    const int sixteenth = column / 16;
    return 0.2f + 0.5f * static_cast<float>(row) / kSide + 0.01f * static_cast<float>(sixteenth) -
           0.02f * static_cast<float>(i);
  }
  void WriteImage(int i, int width, int height) {
    Image image(width, height, {"R", "G", "B"});
    for (int c = 0; c < 3; ++c) {
      for (int p = 0; p < width * height; ++p) {
        image.channel(c)[static_cast<size_t>(p)] = Stored(i, p / width, p % width);
      }
    }
    fs::create_directories(source());
    WritePng(ImageFile(i), image, 16);
  }
  fs::path ImageFile(int i) const { return source() / ("0" + std::to_string(i) + ".png"); }

  Json ViewsJson() const {
    Json json = {{"glint_views", 1},           {"size_mm", {96.0, 96.0}}, {"encoding", "srgb"},
                 {"convention", "photograph"}, {"light_power", 5e4},      {"views", Json::array()}};
    for (int i = 0; i < 3; ++i) {
      json["views"].push_back({{"image", ImageFile(i).filename().string()},
                               {"camera_in_sample_mm", {10.0 * i, -5.0, 200.0}}});
    }
    return json;
  }
  void WriteViews(const Json& json) { test::WriteAll(source() / "views.json", json.dump(1)); }
  void WriteMaterialGan() {
    test::WriteAll(source() / "camera_pos.txt", "1.0,0.5,17\n2.0,-0.5,18\n-1,0,16\n");
    test::WriteAll(source() / "light_pos.txt", "1.0,0.6,17\n2.0,-0.4,18\n-1,0.1,16\n");
    test::WriteAll(source() / "image_size.txt", "9.6\n");
    test::WriteAll(source() / "light_power.txt", "1500,1400,1300\n");
  }

  test::Outcome Import(std::vector<std::string> options = {}) const {
    std::vector<std::string> arguments = {std::string(GLINT_BIN_DIR) + "/glint-import",
                                          source().string(), capture().string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return test::RunProgram(arguments);
  }
  RectifiedSet Set() const { return ReadRectifiedSet(views() / "manifest.json"); }

  // Runs, expects exit code 2 and a message, and that nothing was written.
  void ExpectRejected(const testing::Matcher<std::string>& message,
                      std::vector<std::string> options = {}) {
    const test::Outcome outcome = Import(std::move(options));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, message);
    EXPECT_FALSE(fs::exists(capture() / "capture.toml"));
    EXPECT_FALSE(fs::exists(views() / "manifest.json"));
  }
  // The same without starting the program each time.
  void ExpectViewsRejected(const Json& json, const testing::Matcher<std::string>& message) {
    WriteViews(json);
    try {
      ImportedPlane(ReadForeignSet(source()), ImportOptions());
      ADD_FAILURE() << "accepted: " << json.dump();
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("views.json"), message));
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(ImportProgram, ViewsJsonBecomesARectifiedSet) {
  Json json = ViewsJson();
  json["views"][1]["light_in_sample_mm"] = {1, 2, 150};
  json["views"][1]["exposure"] = 0.5;
  json["views"][2]["light_power"] = {1, 2, 3};
  json["ambient"] = 0.25;
  WriteViews(json);
  const test::Outcome outcome = Import();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const RectifiedSet set = Set();
  ASSERT_EQ(set.views.size(), 3u);
  EXPECT_EQ(set.plane.width, kSide);
  EXPECT_EQ(set.plane.width_mm, 96);
  EXPECT_TRUE(set.light_power_known);
  EXPECT_EQ(set.convention, ReflectanceConvention::Photograph());
  EXPECT_EQ(set.views[0].photo, "00.png");
  EXPECT_TRUE(set.views[0].ldr);
  EXPECT_EQ(set.views[0].view.light_in_sample_mm, set.views[0].view.camera_in_sample_mm);
  EXPECT_EQ(set.views[0].view.light_rgb, (Vec3d{5e4, 5e4, 5e4}));
  EXPECT_EQ(set.views[1].view.light_in_sample_mm, (Vec3d{1, 2, 150}));
  EXPECT_EQ(set.views[1].view.exposure, 0.5);
  EXPECT_EQ(set.views[1].view.ambient_rgb, (Vec3d{0.25, 0.25, 0.25}));
  EXPECT_EQ(set.views[2].view.light_rgb, (Vec3d{1, 2, 3}));
  // One texel a pixel: the values as stored, through the sRGB curve.
  const RectifiedImage image = ReadRectifiedImage(set, set.views[2]);
  for (const int row : {0, 20, 47}) {
    const double expected = std::pow((Stored(2, row, 17) + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(image.rgb[static_cast<size_t>(row) * kSide + 17], expected, 1e-4);
    EXPECT_EQ(image.mask[static_cast<size_t>(row) * kSide + 17], 1);
  }
}

TEST_F(ImportProgram, AKnownPlaneIsTakenAndCamerasAreInItsFrame) {
  Json json = ViewsJson();
  json["plane_mm"] = 2;
  WriteViews(json);
  ASSERT_EQ(Import().code, 0);
  const double stated_mm = json["views"][0]["camera_in_sample_mm"][2].get<double>();
  EXPECT_NEAR(Set().views[0].view.camera_in_sample_mm[2], stated_mm - 2, 1e-9);
  const Manifest manifest = ReadManifest(views() / "manifest.json");
  EXPECT_EQ(manifest.metrics["registration"]["height_mm"].get<double>(), 2);
}

TEST_F(ImportProgram, WithoutRegistrationImagesStayAsTheyAre) {
  WriteViews(ViewsJson());
  ASSERT_EQ(Import({"--registration", "none"}).code, 0);
  const RectifiedSet set = Set();
  const RectifiedImage image = ReadRectifiedImage(set, set.views[1]);
  for (const int row : {0, 20, 47}) {
    const double expected = std::pow((Stored(1, row, 17) + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(image.rgb[static_cast<size_t>(row) * kSide + 17], expected, 1e-4);
  }
}

TEST_F(ImportProgram, APlaneThatIsNoNumberIsRefused) {
  Json json = ViewsJson();
  json["plane_mm"] = "thick";
  ExpectViewsRejected(json, HasSubstr("plane_mm"));
}

TEST_F(ImportProgram, TheCaptureCanBeReadAndHasNoPhotosOrBoard) {
  WriteViews(ViewsJson());
  ASSERT_EQ(Import({"--size", "24"}).code, 0);
  const Capture capture_read = ReadCapture(capture());
  EXPECT_TRUE(capture_read.photos.empty());
  EXPECT_FALSE(capture_read.has_board);
  EXPECT_EQ(capture_read.sample_size_mm[0], 96);
  EXPECT_EQ(capture_read.resolution_px[1], 24);
}

TEST_F(ImportProgram, SizeResamplesInLinearLight) {
  Json json = ViewsJson();
  json["encoding"] = "gamma2.2";
  WriteViews(json);
  ASSERT_EQ(Import({"--size", "12"}).code, 0);
  const RectifiedSet set = Set();
  EXPECT_EQ(set.plane.width, 12);
  EXPECT_EQ(set.plane.width_mm, 96);
  const RectifiedImage image = ReadRectifiedImage(set, set.views[0]);
  // Texel (6, 6) covers rows 24 … 27: its centre is row 25.5 of the ramp.
  const double expected = std::pow(0.2 + 0.5 * 25.5 / kSide + 0.01, 2.2);
  EXPECT_NEAR(image.rgb[6 * 12 + 6], expected, 0.002);
  for (const float mask : image.mask) EXPECT_EQ(mask, 1);
}

TEST_F(ImportProgram, SamplingCornerToCornerKeepsTheCorners) {
  Json json = ViewsJson();
  json["convention"] = "dir2019";
  WriteViews(json);
  ASSERT_EQ(Import({"--size", "17"}).code, 0);
  const RectifiedImage image = ReadRectifiedImage(Set(), Set().views[0]);
  for (const float mask : image.mask) EXPECT_EQ(mask, 1);
  const double bottom = std::pow((Stored(0, 47, 0) + 0.055) / 1.055, 2.4);
  EXPECT_NEAR(image.rgb[16 * 17], bottom, 0.015);
}

TEST_F(ImportProgram, EstimatedPowerIsAGuessThatMakesAlbedoPlausible) {
  Json json = ViewsJson();
  json["light_power"] = "estimate";
  WriteViews(json);
  ASSERT_EQ(Import().code, 0);
  const RectifiedSet set = Set();
  EXPECT_FALSE(set.light_power_known);
  const RectifiedImage image = ReadRectifiedImage(set, set.views[0]);
  const double irradiance = set.views[0].view.light_rgb[0] / (200 * 200);
  const double albedo = image.rgb[24 * kSide + 24] * 3.14159 / irradiance;
  EXPECT_GT(albedo, 0.15);
  EXPECT_LT(albedo, 0.6);
}

TEST_F(ImportProgram, OptionsOverrideTheSource) {
  WriteViews(ViewsJson());
  ASSERT_EQ(Import({"--light-power", "7,8,9", "--convention", "materialgan", "--crop", "16"}).code,
            0);
  const RectifiedSet set = Set();
  EXPECT_EQ(set.views[1].view.light_rgb, (Vec3d{7, 8, 9}));
  EXPECT_EQ(set.convention, ReflectanceConvention::MaterialGan());
  EXPECT_EQ(set.plane.width, 16);
  const RectifiedImage image = ReadRectifiedImage(set, set.views[0]);
  const double first = std::pow((Stored(0, 16, 16) + 0.055) / 1.055, 2.4);
  EXPECT_NEAR(image.rgb[0], first, 1e-4);
}

TEST_F(ImportProgram, MaterialGanIsInCentimetres) {
  WriteMaterialGan();
  const test::Outcome outcome = Import();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const RectifiedSet set = Set();
  EXPECT_NEAR(set.plane.width_mm, 96, 1e-9);
  EXPECT_EQ(set.views[1].view.camera_in_sample_mm, (Vec3d{20, -5, 180}));
  EXPECT_EQ(set.views[1].view.light_in_sample_mm, (Vec3d{20, -4, 180}));
  EXPECT_EQ(set.views[1].view.light_rgb, (Vec3d{150000, 140000, 130000}));
  EXPECT_FALSE(set.light_power_known);
  EXPECT_EQ(set.convention, ReflectanceConvention::MaterialGan());
}

// svbrdf-diff-renderer: one description for each resolution, images in a folder that it names.
TEST_F(ImportProgram, DescriptionsByResolutionNameTheirImages) {
  fs::create_directories(source() / "target/32");
  for (int i = 0; i < 3; ++i) {
    fs::rename(ImageFile(i), source() / "target/32" / ("0" + std::to_string(i) + ".png"));
  }
  const Json json = {{"target_dir", "target/32"},
                     {"optimize_dir", "tex"},
                     {"im_size", 9.6},
                     {"idx", {0, 1, 2}},
                     {"camera_pos", {{1.0, 0.5, 17}, {2.0, -0.5, 18}, {-1, 0, 16}}},
                     {"light_pos", {{1.0, 0.6, 17}, {2.0, -0.4, 18}, {-1, 0.1, 16}}},
                     {"light_pow", {1500, 1400, 1300}}};
  test::WriteAll(source() / "optim_latent_32.json", json.dump());
  const test::Outcome outcome = Import();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const RectifiedSet set = Set();
  EXPECT_NEAR(set.plane.width_mm, 96, 1e-9);
  ASSERT_EQ(set.views.size(), 3u);
  EXPECT_EQ(set.views[1].view.camera_in_sample_mm, (Vec3d{20, -5, 180}));
  EXPECT_EQ(set.views[1].view.light_rgb, (Vec3d{150000, 140000, 130000}));
  // Of two descriptions a person chooses.
  test::WriteAll(source() / "optim_latent_64.json", json.dump());
  EXPECT_THAT(Import().err, testing::HasSubstr("2 descriptions of a set"));
}

TEST_F(ImportProgram, MaterialGanMistakesAreNamed) {
  WriteMaterialGan();
  test::WriteAll(source() / "light_pos.txt", "1,0.6,17\n2,-0.4,18\n");
  ExpectRejected(AllOf(HasSubstr("light_pos.txt"), HasSubstr("2 positions"), HasSubstr("has 3")));
  test::WriteAll(source() / "light_pos.txt", "1,0.6,17\n2,nan,18\n1,1,17\n");
  ExpectRejected(AllOf(HasSubstr("light_pos.txt"), HasSubstr("line 2"), HasSubstr("'nan'")));
  test::WriteAll(source() / "light_pos.txt", "1,0.6,17\n2,18\n1,1,17\n");
  ExpectRejected(AllOf(HasSubstr("light_pos.txt"), HasSubstr("line 2"), HasSubstr("2 numbers")));
  test::WriteAll(source() / "light_pos.txt", "1,0.6,17\n2,1,-18\n1,1,17\n");
  ExpectRejected(AllOf(HasSubstr("line 2"), HasSubstr("light at z = -180")));
  WriteMaterialGan();
  fs::remove(ImageFile(2));
  ExpectRejected(AllOf(HasSubstr("2 images"), HasSubstr("3 positions")));
  WriteMaterialGan();
  WriteImage(2, kSide, kSide);
  fs::remove(source() / "image_size.txt");
  ExpectRejected(HasSubstr("image_size.txt"));
  test::WriteAll(source() / "image_size.txt", "0\n");
  ExpectRejected(AllOf(HasSubstr("image_size.txt"), HasSubstr("centimetres")));
}

TEST_F(ImportProgram, BadFieldsOfViewsJsonAreNamed) {
  test::WriteAll(source() / "views.json", "{\"glint_views\": 1,");
  ExpectRejected(AllOf(HasSubstr("views.json"), HasSubstr("not JSON")));
  ExpectViewsRejected(Json::array(), HasSubstr("object"));
  const auto with = [&](const std::string& field, const Json& value) {
    Json json = ViewsJson();
    json[field] = value;
    return json;
  };
  const auto with_view = [&](const std::string& field, const Json& value) {
    Json json = ViewsJson();
    json["views"][1][field] = value;
    return json;
  };
  Json missing = ViewsJson();
  missing.erase("size_mm");
  ExpectViewsRejected(missing, AllOf(HasSubstr("size_mm"), HasSubstr("no such field")));
  missing = ViewsJson();
  missing["views"][2].erase("camera_in_sample_mm");
  ExpectViewsRejected(missing, HasSubstr("views[2].camera_in_sample_mm"));
  ExpectViewsRejected(with("glint_views", 2), HasSubstr("version 1"));
  ExpectViewsRejected(with("size_mm", {10, -3}), AllOf(HasSubstr("size_mm"), HasSubstr("[10,-3]")));
  ExpectViewsRejected(with("size_mm", {96, 50}), AllOf(HasSubstr("size_mm"), HasSubstr("square")));
  ExpectViewsRejected(with("encoding", "log"), AllOf(HasSubstr("encoding"), HasSubstr("'log'")));
  ExpectViewsRejected(with("convention", "phong"), HasSubstr("'phong'"));
  ExpectViewsRejected(with("light_power", "bright"), HasSubstr("light_power"));
  ExpectViewsRejected(with("light_power", {1, 2}), HasSubstr("light_power"));
  ExpectViewsRejected(with("views", Json::array()), HasSubstr("views"));
  ExpectViewsRejected(with("lights", 1), AllOf(HasSubstr("lights"), HasSubstr("unknown field")));
  ExpectViewsRejected(with_view("camera_in_sample_mm", {1, 2, "x"}),
                      HasSubstr("views[1].camera_in_sample_mm"));
  ExpectViewsRejected(with_view("camera_in_sample_mm", {1, 2, 1e300}),
                      HasSubstr("views[1].camera_in_sample_mm"));
  ExpectViewsRejected(with_view("camera_in_sample_mm", {1, 2, -30}), HasSubstr("views[1]"));
  ExpectViewsRejected(with_view("exposure", 0), HasSubstr("views[1].exposure"));
  ExpectViewsRejected(with_view("image", "00.png"), HasSubstr("second time"));
  ExpectViewsRejected(with_view("image", 7), HasSubstr("views[1].image"));
  ExpectViewsRejected(with_view("focal", 7), HasSubstr("views[1].focal"));
  test::WriteAll(source() / "views.json", "{\"glint_views\": 1, \"size_mm\": [NaN, 1]}");
  ExpectRejected(HasSubstr("not JSON"));
}

TEST_F(ImportProgram, ImagesThatCannotBeUsedAreNamed) {
  WriteViews(ViewsJson());
  fs::remove(ImageFile(1));
  ExpectRejected(HasSubstr("01.png"));
  test::WriteAll(ImageFile(1), "this is text");
  ExpectRejected(AllOf(HasSubstr("01.png"), HasSubstr("no image")));
  test::WriteAll(ImageFile(1), "");
  ExpectRejected(AllOf(HasSubstr("01.png"), HasSubstr("empty")));
  WritePng(ImageFile(1), Image(1, 1, {"R", "G", "B"}), 8);
  ExpectRejected(AllOf(HasSubstr("01.png"), HasSubstr("1x1")));
  WriteImage(1, kSide, kSide + 16);
  ExpectRejected(AllOf(HasSubstr("01.png"), HasSubstr("48x64"), HasSubstr("48x48")));
  WritePng(ImageFile(1), Image(kSide, kSide, {"R", "G", "B"}), 8);
  ExpectRejected(AllOf(HasSubstr("01.png"), HasSubstr("black")));
  Image white(kSide, kSide, {"R", "G", "B"});
  std::fill(white.samples.begin(), white.samples.end(), 1.0f);
  WritePng(ImageFile(1), white, 8);
  ExpectRejected(AllOf(HasSubstr("01.png"), HasSubstr("saturated")));
  Json json = ViewsJson();
  white.samples[5] = std::nanf("");
  WriteExr(source() / "nan.exr", white);
  json["views"][1]["image"] = "nan.exr";
  WriteViews(json);
  ExpectRejected(AllOf(HasSubstr("nan.exr"), HasSubstr("not a number")));
}

TEST_F(ImportProgram, WrongOptionsAreNamed) {
  WriteViews(ViewsJson());
  ExpectRejected(HasSubstr("--light-power"), {"--light-power", "1,2"});
  ExpectRejected(HasSubstr("--light-power"), {"--light-power", "-5"});
  ExpectRejected(HasSubstr("--convention"), {"--convention", "phong"});
  ExpectRejected(HasSubstr("--crop"), {"--crop", "100"});
  ExpectRejected(HasSubstr("--size"), {"--size", "4"});
}

TEST_F(ImportProgram, AnotherCaptureIsNotOverwritten) {
  WriteViews(ViewsJson());
  test::WriteAll(capture() / "capture.toml", "[sample]\nsize_mm = [5, 5]\n");
  const test::Outcome refused = Import();
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("capture.toml"), HasSubstr("--force")));
  EXPECT_EQ(test::ReadAll(capture() / "capture.toml"), "[sample]\nsize_mm = [5, 5]\n");
  EXPECT_FALSE(fs::exists(views()));
  EXPECT_EQ(Import({"--force"}).code, 0);
  EXPECT_THAT(test::ReadAll(capture() / "capture.toml"), HasSubstr("glint-import"));
}

TEST_F(ImportProgram, ASecondImportDoesNothing) {
  WriteViews(ViewsJson());
  ASSERT_EQ(Import({"--threads", "2"}).code, 0);
  const std::string manifest = test::ReadAll(views() / "manifest.json");
  const test::Outcome again = Import({"--threads", "1"});
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.out, HasSubstr("up to date"));
  ASSERT_EQ(Import({"--threads", "1", "--force"}).code, 0);
  EXPECT_EQ(test::ReadAll(views() / "manifest.json"), manifest);
}

TEST_F(ImportProgram, AFolderInNoKnownLayoutIsRejected) {
  ExpectRejected(AllOf(HasSubstr("of unknown layout"), HasSubstr("views.json")));
  fs::remove_all(source());
  ExpectRejected(HasSubstr("no such file or folder"));
}

}  // namespace
}  // namespace glint
