#include "datasets/looks/looks_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/support/generated_block.h"

namespace glint {
namespace {

std::vector<std::string> KeysOf(const std::vector<LooksColumn>& columns) {
  std::vector<std::string> keys;
  for (const LooksColumn& column : columns) keys.push_back(column.key());
  return keys;
}

TEST(LooksFigures, EveryNumberOfLooksHasOneColumn) {
  Looks looks;
  std::set<const double*> numbers;
  for (const LooksFigure& figure : LooksFigures()) {
    EXPECT_EQ(figure.values(looks).size(), ColumnsOf(figure).size()) << figure.key;
    for (const double& number : figure.values(looks)) numbers.insert(&number);
  }
  EXPECT_EQ(numbers.size(), LooksColumns().size());
  EXPECT_EQ(numbers.size() * sizeof(double), sizeof(Looks));
}

TEST(LooksFigures, TheColumnsOfFilesKeepTheirNamesAndOrder) {
  EXPECT_THAT(KeysOf(LooksColumns()),
              testing::ElementsAre("free", "contrast_1_2", "contrast_2_4", "contrast_4_8",
                                   "contrast_8_16", "correlation_1_2", "correlation_2_4",
                                   "correlation_4_8", "ssim", "highlight"));
}

TEST(LooksFigures, ShortTablesHaveTheFinestBands) {
  EXPECT_THAT(KeysOf(LooksColumns(kFineBands)),
              testing::ElementsAre("free", "contrast_1_2", "contrast_2_4", "correlation_1_2",
                                   "correlation_2_4", "ssim", "highlight"));
  EXPECT_EQ(LooksColumns(1)[1].heading(), "contrast 1–2");
  EXPECT_EQ(LooksWidth("contrast 1–2"), 12);
  EXPECT_EQ(LooksWidth("free"), 6);
}

TEST(EvaluationPage, SaysWhatEachFigureOfLooksMeans) {
  std::string table = "| figure | definition | interpretation |\n|---|---|---|\n";
  for (const LooksFigure& figure : LooksFigures()) {
    const size_t bands = figure.bands.size();
    table += std::string("| ") + figure.heading +
             (bands > 0 ? ", " + std::to_string(bands) + " bands" : "") + " | " +
             figure.definition + " | " + figure.interpretation + " |\n";
  }
  test::CompareOrUpdate("docs/evaluation.md", "figures of looks", table);
}

TEST(LooksFigures, MeansAreOverThoseThatKnowAFigure) {
  Looks one, other;
  one.free = 0.2;
  one.contrast[1] = 0.5;
  other.contrast[1] = 1.5;
  const std::vector<Looks> both = {one, other};
  const Looks mean = MeanLooks(both);
  EXPECT_EQ(mean.free, 0.2);
  EXPECT_EQ(mean.contrast[1], 1);
  EXPECT_TRUE(std::isnan(mean.ssim));
  EXPECT_TRUE(std::isnan(MeanLooks({}).free));
}

TEST(LooksFigures, WhatIsUnknownIsNullInFilesAndADashInTables) {
  Looks looks;
  looks.ssim = 0.5;
  looks.contrast[2] = 0.25;
  const Json json = ToJson(looks);
  EXPECT_TRUE(json["free"].is_null());
  EXPECT_EQ(json["ssim"], 0.5);
  EXPECT_EQ(json["contrast"].dump(), "[null,null,0.25,null]");
  EXPECT_EQ(json["correlation"].size(), 3u);
  EXPECT_EQ(LooksText(looks.free, 3), "–");
  EXPECT_EQ(LooksText(looks.ssim, 3), "0.500");
}

}  // namespace
}  // namespace glint
