#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

#include "base/errors/errors.h"
#include "calib/colmap/colmap_camera.h"
#include "calib/colmap/colmap_model.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// Two cameras, three images, four points, with numbers that decimals do not hold exactly.
ColmapModel SmallModel() {
  ColmapModel model;
  model.cameras = {
      {3, *ColmapModelFromName("SIMPLE_RADIAL"), 640, 480, {1.0 / 3, 320, 240, 1e-17}},
      {1, *ColmapModelFromName("OPENCV"), 64, 48, {50, 51, 32, 24, 0.1, -0.2, 0, 0.3}}};
  for (std::uint32_t i = 0; i < 3; ++i) {
    ColmapImage image;
    image.id = 9 - 2 * i;
    image.camera_id = i == 2 ? 1 : 3;
    image.name = "photos/p" + std::to_string(i) + ".jpg";
    image.set_camera_from_model(
        {Eigen::AngleAxisd(0.3 + i, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(),
         {0.1 + i, -1.0 / 7, 1e10 / 3}});
    for (int k = 0; k < 4; ++k) {
      image.observations.push_back({{k / 3.0, 100.0 * k + 0.1}, kNoColmapPoint});
    }
    model.images.push_back(image);
  }
  for (std::uint64_t id : {5ull, 6000000000ull, 2ull, 1ull}) {
    ColmapPoint point;
    point.id = id;
    point.position = {1.0 / 3, -2e-9, 5};
    point.rgb = {0, 128, 255};
    point.error_px = 0.7;
    model.points.push_back(point);
  }
  for (std::uint32_t k = 0; k < 2; ++k) {
    model.points[k].track = {{9, k}, {5, k + 1}};
    model.images[0].observations[k].point_id = model.points[k].id;
    model.images[2].observations[k + 1].point_id = model.points[k].id;
  }
  model.images[1].observations.clear();
  return model;
}

void ExpectSame(const ColmapModel& a, const ColmapModel& b, double quaternion_tolerance = 0) {
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  ASSERT_EQ(a.images.size(), b.images.size());
  ASSERT_EQ(a.points.size(), b.points.size());
  for (size_t i = 0; i < a.cameras.size(); ++i) {
    EXPECT_EQ(a.cameras[i].id, b.cameras[i].id);
    EXPECT_EQ(a.cameras[i].model, b.cameras[i].model);
    EXPECT_EQ(a.cameras[i].width_px, b.cameras[i].width_px);
    EXPECT_EQ(a.cameras[i].height_px, b.cameras[i].height_px);
    EXPECT_EQ(a.cameras[i].parameters, b.cameras[i].parameters);
  }
  for (size_t i = 0; i < a.images.size(); ++i) {
    EXPECT_EQ(a.images[i].id, b.images[i].id);
    EXPECT_EQ(a.images[i].camera_id, b.images[i].camera_id);
    EXPECT_EQ(a.images[i].name, b.images[i].name);
    EXPECT_EQ(a.images[i].translation, b.images[i].translation);
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(a.images[i].quaternion_wxyz[k], b.images[i].quaternion_wxyz[k],
                  quaternion_tolerance);
    }
    ASSERT_EQ(a.images[i].observations.size(), b.images[i].observations.size());
    for (size_t k = 0; k < a.images[i].observations.size(); ++k) {
      EXPECT_EQ(a.images[i].observations[k].point_px, b.images[i].observations[k].point_px);
      EXPECT_EQ(a.images[i].observations[k].point_id, b.images[i].observations[k].point_id);
    }
  }
  for (size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].id, b.points[i].id);
    EXPECT_EQ(a.points[i].position, b.points[i].position);
    EXPECT_EQ(a.points[i].rgb, b.points[i].rgb);
    EXPECT_EQ(a.points[i].error_px, b.points[i].error_px);
    ASSERT_EQ(a.points[i].track.size(), b.points[i].track.size());
    for (size_t k = 0; k < a.points[i].track.size(); ++k) {
      EXPECT_EQ(a.points[i].track[k].image_id, b.points[i].track[k].image_id);
      EXPECT_EQ(a.points[i].track[k].observation, b.points[i].track[k].observation);
    }
  }
}

fs::path Sub(const test::TemporaryFolder& folder, const std::string& name) {
  fs::create_directories(folder.path() / name);
  return folder.path() / name;
}

void SortById(ColmapModel* model) {
  const auto by_id = [](const auto& a, const auto& b) { return a.id < b.id; };
  std::sort(model->cameras.begin(), model->cameras.end(), by_id);
  std::sort(model->images.begin(), model->images.end(), by_id);
  std::sort(model->points.begin(), model->points.end(), by_id);
}

std::string MessageOf(const fs::path& folder) {
  try {
    ReadColmapModel(folder);
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ColmapModel, TextAndBinaryRoundTripsAreLossless) {
  const test::TemporaryFolder folder;
  const ColmapModel model = SmallModel();
  WriteColmapModel(Sub(folder, "text"), model, ColmapFormat::kText);
  const ColmapModel from_text = ReadColmapModel(folder.path() / "text");
  ExpectSame(model, from_text);
  WriteColmapModel(Sub(folder, "binary"), from_text, ColmapFormat::kBinary);
  const ColmapModel from_binary = ReadColmapModel(folder.path() / "binary");
  ExpectSame(model, from_binary);
  WriteColmapModel(Sub(folder, "again"), from_binary, ColmapFormat::kText);
  for (const char* file : {"cameras.txt", "images.txt", "points3D.txt"}) {
    EXPECT_EQ(test::ReadAll(folder.path() / "text" / file),
              test::ReadAll(folder.path() / "again" / file));
  }
}

TEST(ColmapModel, TheColmapProgramReadsBothAndGivesTheSameBack) {
  ASSERT_EQ(std::system("command -v colmap > /dev/null 2>&1"), 0) << "install colmap";
  ::setenv("QT_QPA_PLATFORM", "offscreen", 1);
  const test::TemporaryFolder folder;
  ColmapModel model = SmallModel();
  for (const auto& [format, type] :
       {std::pair{ColmapFormat::kText, "BIN"}, std::pair{ColmapFormat::kBinary, "TXT"}}) {
    const fs::path ours = Sub(folder, std::string("ours") + type);
    const fs::path theirs = Sub(folder, std::string("theirs") + type);
    WriteColmapModel(ours, model, format);
    const test::Outcome outcome =
        test::RunProgram({"colmap", "model_converter", "--input_path", ours.string(),
                          "--output_path", theirs.string(), "--output_type", type});
    ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    ColmapModel back = ReadColmapModel(theirs), sorted = model;
    SortById(&back);
    SortById(&sorted);
    // COLMAP normalises quaternions as it reads.
    ExpectSame(sorted, back, 1e-15);
  }
}

TEST(ColmapModel, ARealModelsTextAndBinaryFilesRoundTrip) {
  const char* given = std::getenv("GLINT_DATA");
  const fs::path data = given ? fs::path(given) : fs::path(GLINT_SOURCE_DIR) / "../shared/data";
  const fs::path real = data / "colmap/planar_table_10photos/final_try_1_workspace";
  if (!fs::exists(real)) GTEST_SKIP() << "no data";
  const test::TemporaryFolder folder;
  for (const fs::path& from : {real, real / "sparse/0"}) {
    const ColmapModel model = ReadColmapModel(from);
    EXPECT_EQ(model.images.size(), 10u);
    EXPECT_EQ(model.points.size(), 2167u);
    WriteColmapModel(Sub(folder, "text"), model, ColmapFormat::kText);
    WriteColmapModel(Sub(folder, "binary"), ReadColmapModel(folder.path() / "text"),
                     ColmapFormat::kBinary);
    ExpectSame(model, ReadColmapModel(folder.path() / "binary"));
    if (from == real) continue;
    for (const char* file : {"cameras.bin", "images.bin", "points3D.bin"}) {
      EXPECT_TRUE(test::ReadAll(folder.path() / "binary" / file) == test::ReadAll(from / file));
    }
  }
}

TEST(ColmapModel, EveryCutOfABinaryFileIsAnErrorThatNamesIt) {
  const test::TemporaryFolder folder;
  WriteColmapModel(folder.path(), SmallModel(), ColmapFormat::kBinary);
  for (const char* name : {"cameras.bin", "images.bin", "points3D.bin"}) {
    const fs::path file = folder.path() / name;
    const std::string whole = test::ReadAll(file);
    for (size_t bytes = 0; bytes < whole.size(); ++bytes) {
      test::WriteAll(file, whole.substr(0, bytes));
      ASSERT_THAT(MessageOf(folder.path()), HasSubstr(name)) << bytes;
    }
    test::WriteAll(file, whole + "x");
    EXPECT_THAT(MessageOf(folder.path()), HasSubstr("1 bytes after the last record"));
    test::WriteAll(file, whole);
  }
  EXPECT_EQ(MessageOf(folder.path()), "no error");
}

TEST(ColmapModel, ACountThatTheFileIsTooShortForAllocatesNothing) {
  const test::TemporaryFolder folder;
  WriteColmapModel(folder.path(), SmallModel(), ColmapFormat::kBinary);
  for (const char* name : {"cameras.bin", "images.bin", "points3D.bin"}) {
    const fs::path file = folder.path() / name;
    const std::string whole = test::ReadAll(file);
    std::string huge = whole;
    const std::uint64_t count = 1ull << 60;
    std::memcpy(huge.data(), &count, sizeof(count));
    test::WriteAll(file, huge);
    EXPECT_THAT(MessageOf(folder.path()), HasSubstr("truncated"));
    test::WriteAll(file, whole);
  }
}

TEST(ColmapModel, BytesChangedAtRandomNeverCrash) {
  const test::TemporaryFolder folder;
  WriteColmapModel(folder.path(), SmallModel(), ColmapFormat::kBinary);
  std::uint32_t state = 1;
  const auto next = [&] { return state = state * 1664525u + 1013904223u; };
  int refused = 0;
  for (int i = 0; i < 600; ++i) {
    const char* name = std::array{"cameras.bin", "images.bin", "points3D.bin"}[i % 3];
    const fs::path file = folder.path() / name;
    const std::string whole = test::ReadAll(file);
    std::string changed = whole;
    for (int k = 0; k < 3; ++k) changed[(next() >> 8) % changed.size()] ^= 1 << (next() >> 29);
    test::WriteAll(file, changed);
    refused += MessageOf(folder.path()) != "no error";
    test::WriteAll(file, whole);
  }
  EXPECT_GT(refused, 100);
}

TEST(ColmapModel, MissingFilesAreNamed) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(MessageOf(folder.path() / "none"), HasSubstr("no such folder"));
  EXPECT_THAT(MessageOf(folder.path()), HasSubstr("cameras.txt: found no such file"));
  WriteColmapModel(folder.path(), SmallModel(), ColmapFormat::kBinary);
  fs::remove(folder.path() / "points3D.bin");
  EXPECT_THAT(MessageOf(folder.path()), HasSubstr("points3D.bin: found no such file"));
  EXPECT_THAT(MessageOf(folder.path()), HasSubstr("Export model"));
}

TEST(ColmapModel, ProjectsKeepTheirModelInSparse0) {
  const test::TemporaryFolder folder;
  WriteColmapModel(Sub(folder, "sparse/0"), SmallModel(), ColmapFormat::kBinary);
  std::vector<fs::path> files;
  EXPECT_EQ(ReadColmapModel(folder.path(), &files).images.size(), 3u);
  EXPECT_EQ(files[0], folder.path() / "sparse/0" / "cameras.bin");
}

TEST(ColmapModel, AnotherVersionsCameraModelIsNamed) {
  const test::TemporaryFolder folder;
  WriteColmapModel(folder.path(), SmallModel(), ColmapFormat::kBinary);
  std::string cameras = test::ReadAll(folder.path() / "cameras.bin");
  cameras[12] = 11;  // RAD_TAN_THIN_PRISM_FISHEYE, since 3.10
  test::WriteAll(folder.path() / "cameras.bin", cameras);
  EXPECT_THAT(MessageOf(folder.path()), HasSubstr("camera 3: found camera model number 11"));
  EXPECT_THAT(MessageOf(folder.path()), HasSubstr("another version"));

  const fs::path text = Sub(folder, "text");
  WriteColmapModel(text, SmallModel(), ColmapFormat::kText);
  test::WriteAll(text / "cameras.txt", "1 SIMPLE_DIVISION 640 480 500 320 240 0.1\n");
  EXPECT_THAT(MessageOf(text), HasSubstr("'SIMPLE_DIVISION'"));
}

TEST(ColmapModel, FilesThatDoNotBelongTogetherAreRefused) {
  const test::TemporaryFolder folder;
  ColmapModel model = SmallModel();
  model.cameras.pop_back();
  WriteColmapModel(folder.path(), model, ColmapFormat::kBinary);
  EXPECT_THAT(MessageOf(folder.path()), HasSubstr("camera 1, which cameras.bin does not have"));
  model = SmallModel();
  model.points.erase(model.points.begin());
  WriteColmapModel(folder.path(), model, ColmapFormat::kBinary);
  EXPECT_THAT(MessageOf(folder.path()), HasSubstr("point 5, which points3D.bin does not have"));
  model = SmallModel();
  model.points[0].track[0].observation = 77;
  WriteColmapModel(folder.path(), model, ColmapFormat::kBinary);
  EXPECT_THAT(MessageOf(folder.path()), HasSubstr("feature 77 of image 9"));
  model = SmallModel();
  model.images[1].id = model.images[0].id;
  WriteColmapModel(folder.path(), model, ColmapFormat::kBinary);
  EXPECT_THAT(MessageOf(folder.path()), HasSubstr("the same id twice"));
}

TEST(ColmapModel, TextErrorsNameTheLine) {
  const test::TemporaryFolder folder;
  WriteColmapModel(folder.path(), SmallModel(), ColmapFormat::kText);
  test::WriteAll(folder.path() / "points3D.txt", "# points\n1 0 0 zero 1 2 3 0.5\n");
  EXPECT_THAT(MessageOf(folder.path()), HasSubstr("points3D.txt: line 2: position: found 'zero'"));
  test::WriteAll(folder.path() / "points3D.txt", "1 0 0 0 1 2 3 0.5 9\n");
  EXPECT_THAT(MessageOf(folder.path()), HasSubstr("track's feature: found the line's end"));
  test::WriteAll(folder.path() / "points3D.txt", "1 0 0 0 1 2 300 0.5\n");
  EXPECT_THAT(MessageOf(folder.path()), HasSubstr("colour: found '300'"));
}

TEST(ColmapModel, NamesThatTextCannotHoldAreRefusedThereAndKeptInBinary) {
  const test::TemporaryFolder folder;
  ColmapModel model = SmallModel();
  model.images[0].name = "IMG 1.jpg";
  EXPECT_THROW(WriteColmapModel(folder.path(), model, ColmapFormat::kText), UserError);
  WriteColmapModel(folder.path(), model, ColmapFormat::kBinary);
  fs::remove(folder.path() / "cameras.txt");
  EXPECT_EQ(ReadColmapModel(folder.path()).images[0].name, "IMG 1.jpg");
}

}  // namespace
}  // namespace glint
