#include "datasets/evaluation/paper_experiments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/errors/errors.h"
#include "datasets/evaluation/paper_figures.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using testing::HasSubstr;

const PaperExperiment& Of(const std::string& name) {
  const auto& all = PaperExperiments();
  return *std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
}

Experiment Made(const std::string& name, PaperExperimentOptions options = {}) {
  return Of(name).make(Completed(Of(name), std::move(options)));
}

const Condition& Named(const Experiment& experiment, const std::string& name) {
  const auto& all = experiment.conditions;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
  if (found == all.end()) throw std::out_of_range(name);
  return *found;
}

TEST(PaperFigures, AreThePapers) {
  EXPECT_NEAR(PaperTable1(20, "refined")->maps.average(), 0.01172, 1e-5);
  EXPECT_NEAR(PaperTable1(1, "classic")->maps.average(), 0.03215, 2e-5);
  EXPECT_FALSE(PaperTable1(3, "latent"));
  EXPECT_NEAR(PaperTable2(5, 0)->map_average / PaperTable2(0, 0)->map_average, 1.13, 0.005);
  EXPECT_NEAR(PaperTable2(0, 5)->render / PaperTable2(0, 0)->render, 2.2, 0.06);
  EXPECT_FALSE(PaperTable2(5, 5));
}

// Results of one condition or method must not overwrite another's.
TEST(PaperExperiments, ConditionsAndMethodsHaveFoldersOfTheirOwn) {
  const test::TemporaryFolder folder;
  test::WriteAll(folder.path() / "w", "weights");
  PaperExperimentOptions options;
  options.disturb = true;
  const std::string file = (folder.path() / "w").string();
  options.weights = {"all=" + file, "none=" + file};
  for (const PaperExperiment& paper : PaperExperiments()) {
    const Experiment experiment = paper.make(Completed(paper, options));
    std::set<std::string> folders, names, methods;
    for (const Condition& condition : experiment.conditions) {
      EXPECT_TRUE(folders.insert(condition.folder).second) << condition.folder;
      EXPECT_TRUE(names.insert(condition.name + std::to_string(condition.views.count)).second);
    }
    for (const Method& method : experiment.methods) {
      EXPECT_TRUE(methods.insert(method.name).second) << method.name;
    }
    EXPECT_FALSE(experiment.methods.empty());
    EXPECT_EQ(experiment.name, paper.name);
  }
}

TEST(PaperExperiments, DisturbOnlyWhatTheyName) {
  PaperExperimentOptions options;
  options.views.disturbance.environment = "room.hdr";
  const Experiment table2 = Made("table2", options);
  EXPECT_EQ(table2.conditions.size(), 7u);
  EXPECT_FALSE(Named(table2, "undisturbed").views.disturbance.any());
  EXPECT_EQ(Named(table2, "light off by 5°").views.disturbance.light_off_deg, 5);
  EXPECT_EQ(Named(table2, "light off by 5°").views.disturbance.environment_percent, 0);
  EXPECT_EQ(Named(table2, "environment 10 %").views.disturbance.environment_percent, 10);
  EXPECT_EQ(Named(table2, "environment 10 %").views.disturbance.environment, "room.hdr");
  options.disturb = true;
  const Disturbance all = Named(Made("table1", options), kDisturbed).views.disturbance;
  EXPECT_EQ(all.light_off_deg, 5);
  EXPECT_EQ(all.environment_percent, 5);
  EXPECT_EQ(all.registration_texel, 0.5);
  EXPECT_EQ(Named(Made("exposure"), "-6 stops").views.exposure_stops, -6);
  EXPECT_TRUE(Made("exposure").count_saturated);
  EXPECT_EQ(Named(Made("hdr"), "float").views.bits, "float");
  EXPECT_EQ(Named(Made("topview"), "all ≥ 45° off").views.least_tilt_deg, 45);
  EXPECT_EQ(Made("count").conditions.size(), 7u);
  EXPECT_EQ(Made("start").methods.size(), 15u);
}

TEST(PaperExperiments, AblationNeedsFilesThatAreThere) {
  EXPECT_THROW(Made("ablation"), UserError);
  PaperExperimentOptions options;
  for (const std::string wrong : {"name", "=file", "name=", "a/b=file", "name=/nonexistent"}) {
    options.weights = {wrong};
    EXPECT_THROW(Made("ablation", options), UserError) << wrong;
  }
  const test::TemporaryFolder folder;
  test::WriteAll(folder.path() / "w", "weights");
  options.weights = {"none=" + (folder.path() / "w").string()};
  EXPECT_EQ(Made("ablation", options).methods[1].name, "none-refined");
  options.methods = {"classic"};
  EXPECT_THROW(Made("ablation", options), UserError);
}

ExperimentEntry Entry(int count, const std::string& condition, const std::string& method,
                      double maps, double render) {
  ExperimentEntry entry{"a", count, condition, method, {}, -1};
  entry.errors.maps = {maps, maps, maps, maps};
  entry.errors.render = render;
  return entry;
}

TEST(PaperExperiments, SummariesAreRatiosOfMeans) {
  const ExperimentResult table1{
      "table1",
      {Entry(5, "", "classic", 0.4, 0.2), Entry(5, "", "refined", 0.1, 0.1),
       Entry(5, kDisturbed, "classic", 0.4, 0.2), Entry(5, kDisturbed, "refined", 0.3, 0.2)}};
  Json json;
  const std::string text = Of("table1").summary(table1, &json);
  EXPECT_THAT(text, HasSubstr("|  5 | undisturbed | 0.250       | 0.500  | 0.751 | 0.664 |"));
  EXPECT_THAT(text, HasSubstr("|  5 | disturbed   | 0.750       | 1.000  |  |  |"));
  EXPECT_EQ(json["refined_over_classic"].size(), 2u);
  EXPECT_EQ(json["paper"].size(), 2u);

  const ExperimentResult table2{"table2",
                                {Entry(20, "undisturbed", "refined", 0.1, 0.1),
                                 Entry(20, "light off by 5°", "refined", 0.2, 0.4)}};
  EXPECT_THAT(Of("table2").summary(table2, &json),
              HasSubstr("| 20 | light off by 5° | refined | 2.000 | 4.000 | 1.127 | 2.770 |"));
  EXPECT_NEAR(json[0]["render"].get<double>(), 4, 1e-12);
}

TEST(PlotOf, IsOverViewsOrOverConditions) {
  ExperimentResult result{"r",
                          {Entry(1, "", "latent", 0.4, 0.2), Entry(5, "", "latent", 0.1, 0.1)}};
  const Plot views = PlotOf(result, Of("table1").paper);
  EXPECT_TRUE(views.categories.empty());
  ASSERT_EQ(views.panels[0].series.size(), 2u);  // ours and the paper's
  EXPECT_EQ(views.panels[0].series[1].dashed_like, 0);
  EXPECT_EQ(views.panels[1].series[0].points[1], std::make_pair(5.0, 0.1));
  result.entries = {Entry(5, "dark", "latent", 0.4, 0.2), Entry(5, "bright", "latent", 0.1, 0.1)};
  const Plot conditions = PlotOf(result, {});
  EXPECT_EQ(conditions.categories, (std::vector<std::string>{"dark", "bright"}));
  EXPECT_EQ(conditions.panels[0].series[0].points[1].first, 1);
  result.entries = {Entry(5, "", "latent", 0.4, 0.2), Entry(5, "", "refined", 0.1, 0.1)};
  const Plot methods = PlotOf(result, {});
  EXPECT_EQ(methods.categories, (std::vector<std::string>{"latent", "refined"}));
  EXPECT_EQ(methods.panels[0].series.size(), 1u);
}

}  // namespace
}  // namespace glint
