#include "datasets/evaluation/experiment_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace glint {
namespace {

using testing::HasSubstr;
using testing::Not;

ExperimentEntry Entry(const std::string& material, int count, const std::string& method,
                      double value, const std::string& condition = "") {
  ExperimentEntry entry{material, count, condition, method, {}, -1};
  entry.errors.maps.diffuse = value;
  entry.errors.maps.roughness = 2 * value;
  entry.errors.render = 10 * value;
  return entry;
}

ExperimentResult Example() {
  return {"table1",
          {Entry("a", 5, "classic", 0.1), Entry("a", 1, "latent", 0.5),
           Entry("b", 5, "classic", 0.3), Entry("b", 1, "latent", 0.7)}};
}

TEST(ExperimentResult, MeansAreOverMaterialsByCountAndMethod) {
  const auto means = Example().Means();
  ASSERT_EQ(means.size(), 2u);
  EXPECT_EQ(means[0].count, 1);  // ordered by number of views
  EXPECT_EQ(means[0].method, "latent");
  EXPECT_NEAR(means[0].errors.maps.diffuse, 0.6, 1e-12);
  EXPECT_EQ(means[1].method, "classic");
  EXPECT_NEAR(means[1].errors.maps.diffuse, 0.2, 1e-12);
  EXPECT_NEAR(means[1].errors.maps.average(), 0.15, 1e-12);
  EXPECT_NEAR(means[1].errors.render, 2, 1e-12);
}

TEST(ExperimentResult, IsWrittenInThreeForms) {
  const ExperimentResult result = Example();
  EXPECT_THAT(result.Text(), HasSubstr("|  5 | classic | 0.200000 |"));
  EXPECT_THAT(result.Csv(), HasSubstr("b,5,classic,0.3,0,0.6,0,0.225,3\n"));
  EXPECT_THAT(result.Csv(), HasSubstr("mean,1,latent,0.6,"));
  EXPECT_EQ(result.ToJson()["entries"].size(), 4u);
  EXPECT_EQ(result.ToJson()["means"][1]["errors"]["map_average"].get<double>(),
            result.Means()[1].errors.maps.average());
}

TEST(ExperimentResult, ConditionsAreCellsOfTheirOwn) {
  ExperimentResult result;
  result.entries = {
      Entry("a", 5, "latent", 0.1, "plain"), Entry("a", 5, "latent", 0.3, "dark, cold"),
      Entry("b", 5, "latent", 0.2, "plain"), Entry("b", 5, "latent", 0.5, "dark, cold")};
  EXPECT_EQ(result.Means().size(), 2u);
  EXPECT_NEAR(result.Mean(5, "dark, cold", "latent")->errors.maps.diffuse, 0.4, 1e-12);
  EXPECT_FALSE(result.Mean(4, "plain", "latent"));
  EXPECT_THAT(result.Csv(), HasSubstr("a,5,\"dark, cold\",latent,0.3,"));
  EXPECT_THAT(result.Text(), HasSubstr("|  5 | plain      | latent  | 0.150000 |"));
  EXPECT_THAT(Example().Csv(), Not(HasSubstr("condition")));
}

TEST(ExperimentResult, SaturationIsAveragedAndShown) {
  ExperimentResult result = Example();
  result.entries[0].saturated = 0.1;
  result.entries[2].saturated = 0.3;
  EXPECT_NEAR(result.Mean(5, "", "classic")->saturated, 0.2, 1e-12);
  EXPECT_THAT(result.Text(), HasSubstr("20.00% |"));
  EXPECT_THAT(Example().Text(), Not(HasSubstr("saturated")));
}

TEST(ExperimentResult, ThePapersFiguresStandBeside) {
  const auto paper = [](const ExperimentEntry& mean) -> std::optional<PaperFigures> {
    if (mean.count != 5) return std::nullopt;
    return PaperFigures{0.01, 0.002};
  };
  EXPECT_THAT(Example().Text(paper), HasSubstr("2.000000 |    0.01000 |      0.002000 |\n"));
}

}  // namespace
}  // namespace glint
