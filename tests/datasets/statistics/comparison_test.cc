#include "datasets/statistics/comparison.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "base/errors/errors.h"
#include "base/formats/svbrdf_file.h"
#include "datasets/procedural/material.h"
#include "datasets/statistics/comparison_files.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

Population Measured(const std::string& family, int first, int count, int threads = 2) {
  return MeasureMaterials("some", ProceduralMaterials(family, static_cast<uint64_t>(first), count),
                          64, threads);
}

fs::path FreshFolder(const std::string& name) {
  const fs::path folder = fs::path(testing::TempDir()) / name;
  fs::remove_all(folder);
  return folder;
}

std::string Bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(ComparisonTest, APopulationIsAtZeroFromItself) {
  const Population one = Measured("", 0, 12);
  const Comparison same = Compare(one, one);
  for (const Distance& d : same.distances) {
    EXPECT_EQ(d.ks, 0) << d.name;
    EXPECT_EQ(d.wasserstein, 0) << d.name;
  }
}

TEST(ComparisonTest, AnotherFamilyIsFartherThanOtherSeedsOfTheSame) {
  const Population stones = Measured("stone", 0, 16);
  const double alike = Compare(stones, Measured("stone", 100, 16)).MeanDistance("");
  const double other = Compare(stones, Measured("smooth", 0, 16)).MeanDistance("");
  EXPECT_GT(other, 1.4 * alike);
}

TEST(ComparisonTest, FilesHaveTheSameBytesForAnyNumberOfThreads) {
  const fs::path one = FreshFolder("statistics_1"), three = FreshFolder("statistics_3");
  WriteComparison(one, Compare(Measured("", 0, 5, 1), Measured("", 9, 7, 1)));
  WriteComparison(three, Compare(Measured("", 0, 5, 3), Measured("", 9, 7, 3)));
  for (const char* name : {"statistics.json", "statistics.csv", "statistics.png"}) {
    EXPECT_FALSE(Bytes(one / name).empty()) << name;
    EXPECT_EQ(Bytes(one / name), Bytes(three / name)) << name;
  }
}

TEST(ComparisonTest, CsvHasALineForEveryMaterialOfBothSides) {
  const std::string csv = TraitCsv(Compare(Measured("", 0, 3), Measured("", 5, 4)));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 + 4);
  EXPECT_EQ(csv.find("side,material,diffuse_mean"), 0u);
  EXPECT_NE(csv.find("\ngenerated,procedural_5,"), std::string::npos);
}

TEST(ComparisonTest, MapsOnDiskMeasureAsTheyWereMade) {
  const fs::path folder = FreshFolder("statistics_maps");
  for (const int seed : {3, 4}) {
    const fs::path one = folder / std::to_string(seed);
    fs::create_directories(one);
    WriteSvbrdf(one / "svbrdf.exr", MakeMaterial(static_cast<uint64_t>(seed), 64, 64),
                ReflectanceConvention::Photograph());
  }
  const auto found = FindMaterials({folder.string()});
  ASSERT_EQ(found.size(), 2u);
  const Comparison same = Compare(MeasureMaterials("real", found, 64, 1), Measured("", 3, 2));
  EXPECT_LT(same.MeanDistance(""), 1e-9);
}

TEST(ComparisonTest, AnEmptyFolderIsTheUsersError) {
  const fs::path folder = FreshFolder("statistics_empty");
  fs::create_directories(folder);
  EXPECT_THROW(FindMaterials({folder.string()}), UserError);
}

TEST(ComparisonTest, ASizeThatIsNoPowerOfTwoIsTheUsersError) {
  EXPECT_THROW(MeasureMaterials("some", ProceduralMaterials("", 0, 1), 100, 1), UserError);
  EXPECT_THROW(MeasureMaterials("some", ProceduralMaterials("", 0, 1), 4, 1), UserError);
}

}  // namespace
}  // namespace glint
