// Exports of maps that are larger than what is held in memory at once.
#include "pipeline/export/export_stage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/formats/svbrdf_file.h"
#include "base/photos/photo.h"
#include "base/reflectance/border.h"
#include "pipeline/export/material_rows.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 40, kHeight = 32;

// Bumps, of a substance that changes from left to right.
SvbrdfMaps Bumps() {
  SvbrdfMaps maps(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const float x = 0.3f * std::cos(0.5f * static_cast<float>(column));
      const float y = 0.2f * std::sin(0.4f * static_cast<float>(row));
      maps.at(kNormalX, row, column) = x;
      maps.at(kNormalY, row, column) = y;
      maps.at(kNormalZ, row, column) = std::sqrt(1 - x * x - y * y);
      for (int c = 0; c < 3; ++c) {
        const float share = static_cast<float>(column) / kWidth;
        maps.at(kDiffuseR + c, row, column) = 0.4f * (1 - share);
        maps.at(kSpecularR + c, row, column) = 0.04f + 0.6f * share;
      }
      maps.at(kRoughness, row, column) = 0.3f + 0.01f * static_cast<float>(row);
    }
  }
  return maps;
}

class ExportStageTest : public ::testing::Test {
 protected:
  ExportStageTest() { WriteSvbrdf(folder_ / "maps/svbrdf.exr", Bumps(), ReflectanceConvention()); }

  // The folder of the files.
  fs::path Export(const std::string& name, int rows_at_once, int material_size, int threads) {
    const fs::path input = folder_ / "input";
    test::WriteAll(input, "x");
    ExportOptions options;
    OptionSet set;
    AddExportOptions(&set, &options);
    options.material_size = material_size;
    Stage stage(folder_.path() / name, {"export", 1}, set, CommonOptions(), {input});
    const ExportTask task{folder_ / "maps/manifest.json", {100, 80}, false, rows_at_once};
    const Json data = ExportMaterial(task, options, MaterialFormats(), threads, &stage);
    stage.Commit(data, Json::object());
    return folder_.path() / name;
  }

  static void ExpectSameFiles(const fs::path& a, const fs::path& b) {
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(a)) {
      if (!entry.is_regular_file() || entry.path().filename() == "run.json") continue;
      const fs::path name = entry.path().lexically_relative(a);
      EXPECT_EQ(test::ReadAll(entry.path()), test::ReadAll(b / name)) << name;
      ++files;
    }
    EXPECT_GT(files, 11);
  }

  struct Folder : test::TemporaryFolder {
    Folder() { fs::create_directories(path() / "maps"); }
  } folder_;
};

TEST_F(ExportStageTest, RowsAndThreadsDoNotChangeAByte) {
  const fs::path whole = Export("whole", kHeight, 4096, 1);
  ExpectSameFiles(whole, Export("rows", 5, 4096, 3));
  const fs::path small = Export("small", kHeight, 16, 1);
  ExpectSameFiles(small, Export("small_rows", 5, 16, 2));
}

// Height and occlusion of averaged maps, on pictures of the maps' own size.
TEST_F(ExportStageTest, LargeMapsKeepTheirSizeAndTheirRelief) {
  const fs::path whole = Export("whole", 0, 4096, 1), small = Export("small", 0, 20, 1);
  for (const char* map : {"basecolor", "metallic", "roughness", "normal_gl"}) {
    const std::string file = "material_" + std::string(map) + ".png";
    EXPECT_EQ(test::ReadAll(small / file), test::ReadAll(whole / file)) << map;
  }
  for (const char* map : {"height", "ao"}) {
    const std::string file = "material_" + std::string(map) + ".png";
    const Image exact = ReadPhoto(whole / file).image.Planes();
    const Image averaged = ReadPhoto(small / file).image.Planes();
    ASSERT_EQ(averaged.width, kWidth);
    ASSERT_EQ(averaged.height, kHeight);
    double sum = 0, squares = 0, difference = 0;
    for (size_t i = 0; i < exact.pixels(); ++i) {
      sum += exact.samples[i] / static_cast<double>(exact.pixels());
      squares += exact.samples[i] * exact.samples[i] / static_cast<double>(exact.pixels());
      const double d = exact.samples[i] - averaged.samples[i];
      difference += d * d / static_cast<double>(exact.pixels());
    }
    const bool height = map == std::string("height");
    EXPECT_LT(difference, height ? 0.1 * (squares - sum * sum) : 1e-4) << map;
  }
}

TEST_F(ExportStageTest, RowsHaveTheBorderOfTheWhole) {
  SvbrdfMaps whole = Bumps();
  ContinueBorder(&whole, 3);
  MaterialRows rows(folder_ / "maps/svbrdf.exr", 3);
  for (const auto& [first, count] : {std::pair{0, 2}, std::pair{1, 9}, std::pair{20, 12},
                                     std::pair{kHeight - 1, 1}, std::pair{0, kHeight}}) {
    const SvbrdfMaps part = rows.Rows(first, count);
    for (int p = 0; p < kSvbrdfPlanes; ++p) {
      EXPECT_TRUE(std::equal(part.plane(p).begin(), part.plane(p).end(),
                             whole.plane(p).begin() + first * kWidth))
          << first;
    }
  }
}

}  // namespace
}  // namespace glint
