#include "datasets/evaluation/table1.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/contract/errors.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using testing::HasSubstr;

Table1Entry Entry(const std::string& material, int count, const std::string& method, double value) {
  Table1Entry entry{material, count, method, {}};
  entry.errors.maps.diffuse = value;
  entry.errors.maps.roughness = 2 * value;
  entry.errors.render = 10 * value;
  return entry;
}

Table1 Example() {
  Table1 table;
  table.entries = {Entry("a", 5, "classic", 0.1), Entry("a", 1, "latent", 0.5),
                   Entry("b", 5, "classic", 0.3), Entry("b", 1, "latent", 0.7)};
  return table;
}

TEST(Table1, MeansAreOverMaterialsByCountAndMethod) {
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

TEST(Table1, IsWrittenInThreeForms) {
  const Table1 table = Example();
  EXPECT_THAT(table.Text(), HasSubstr("|  5 | classic | 0.200000 |"));
  EXPECT_THAT(table.Csv(), HasSubstr("b,5,classic,0.3,0,0.6,0,0.225,3\n"));
  EXPECT_THAT(table.Csv(), HasSubstr("mean,1,latent,0.6,"));
  EXPECT_EQ(table.ToJson()["entries"].size(), 4u);
  EXPECT_EQ(table.ToJson()["means"][1]["errors"]["map_average"].get<double>(),
            table.Means()[1].errors.maps.average());
}

TEST(RunTable1, AFinishedResultIsKept) {
  const test::TemporaryFolder folder;
  Table1Options options;
  options.materials = {"procedural:1000000000"};
  options.counts = {2};
  options.methods = {"classic"};
  options.work = folder.path();
  options.size = 16;
  CommonOptions common;
  common.threads = 1;
  // The settings a run with these options writes.
  const Json settings = {{"method", "classic"},
                         {"size", 16},
                         {"rule", "dir"},
                         {"bits", "8"},
                         {"encoding", "gamma2.2"},
                         {"seed", 0},
                         {"fit_arguments", Json::array()}};
  const Json errors = {{"diffuse", 0.25}, {"specular", 0},         {"roughness", 0},
                       {"normal", 0},     {"map_average", 0.0625}, {"render", 0.5}};
  test::WriteAll(folder.path() / "procedural_1000000000" / "n02" / "classic.json",
                 Json{{"settings", settings}, {"errors", errors}}.dump());
  std::string said;
  const Table1 table = RunTable1(options, common, [&](const std::string& text) { said += text; });
  ASSERT_EQ(table.entries.size(), 1u);
  EXPECT_EQ(table.entries[0].errors.render, 0.5);
  EXPECT_THAT(said, HasSubstr("(kept)"));
  // Other settings: it has to run again, which no glint-fit does with this option.
  options.fit_arguments = {"--no-such-option"};
  EXPECT_THROW(RunTable1(options, common, [](const std::string&) {}), Error);
}

TEST(RunTable1, WrongOptionsAreUserErrors) {
  Table1Options options;
  options.methods = {"guess"};
  EXPECT_THROW(RunTable1(options, {}, [](const std::string&) {}), UserError);
  options.methods = {"latent"};
  options.counts = {0};
  EXPECT_THROW(RunTable1(options, {}, [](const std::string&) {}), UserError);
}

}  // namespace
}  // namespace glint
