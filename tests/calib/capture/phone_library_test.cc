#include "calib/capture/phone_library.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "base/errors/errors.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

class PhoneLibrary : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  void Keep(const std::string& name, const std::string& phone, double focal, double sigma) {
    std::ofstream(folder_ / name) << fmt::format(
        R"({{"glint_manifest": 1, "stage": "calib", "stage_version": 2, "inputs": [], "options": {{}},
        "outputs": [], "data": {{}}, "metrics": {{"cameras": [{{"model": "SIMPLE_RADIAL",
        "size_px": [4000, 3000], "exif_camera": "{}", "focal_length_35mm": 26, "parameters":
        {{"f": {{"value": {}, "sigma": {}}}, "cx": {{"value": 2000, "sigma": 1}},
        "cy": {{"value": 1500, "sigma": 1}}, "k": {{"value": 0.1, "sigma": 0.01}}}}}}]}}}})",
        phone, focal, sigma);
  }

  fs::path folder_ = fs::temp_directory_path() / ("glint_library_" + std::to_string(::getpid()));
  PhoneIdentity phone_{"Maker Phone 7", 26, 4000, 3000};
};

TEST_F(PhoneLibrary, TakesTheSurestCalibrationOfThePhone) {
  Keep("a.json", "Maker Phone 7", 3100, 4);
  Keep("b.json", "Maker Phone 7", 3101, 1);
  Keep("c.json", "Maker Phone 8", 3200, 0.1);
  Keep("taken.json", "Maker Phone 7", 3102, 0);  // its intrinsics were given to it
  const auto found = FindPhone(folder_, phone_);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->file.filename(), "b.json");
  EXPECT_EQ(found->camera.parameters, (std::vector<double>{3101, 2000, 1500, 0.1}));
  EXPECT_EQ(found->camera.model, CameraModel::kSimpleRadial);
}

TEST_F(PhoneLibrary, TellsOtherLensesSizesAndNamelessPhotographsApart) {
  Keep("a.json", "Maker Phone 7", 3100, 4);
  ASSERT_TRUE(FindPhone(folder_, phone_));
  EXPECT_FALSE(FindPhone(folder_, {"Maker Phone 7", 13, 4000, 3000}));
  EXPECT_FALSE(FindPhone(folder_, {"Maker Phone 7", 26, 3000, 4000}));
  EXPECT_FALSE(FindPhone(folder_, {"", 26, 4000, 3000}));
}

TEST_F(PhoneLibrary, RefusesWhatIsNoManifest) {
  EXPECT_THROW(LibraryFiles(folder_ / "none"), UserError);
  std::ofstream(folder_ / "notes.json") << "{}";
  EXPECT_THROW(FindPhone(folder_, phone_), UserError);
}

}  // namespace
}  // namespace glint
