#include "datasets/evaluation/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "base/errors/errors.h"
#include "base/files/hash.h"
#include "base/formats/svbrdf_file.h"
#include "datasets/evaluation/capture_store.h"
#include "datasets/evaluation/shipped_models.h"
#include "datasets/evaluation/starts.h"
#include "datasets/procedural/material.h"
#include "fitting/latent/fit_stage.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

const auto kSilent = [](const std::string&) {};

Experiment Example(const fs::path& work, const std::string& method) {
  Experiment experiment;
  experiment.name = "example";
  experiment.materials = {"procedural:1000000000"};
  experiment.work = work;
  experiment.size = 16;
  Condition condition;
  condition.folder = "n02";
  condition.views.count = 2;
  experiment.conditions = {condition};
  experiment.methods = {NamedMethod(method, {}, {})};
  return experiment;
}

CommonOptions OneThread() {
  CommonOptions common;
  common.threads = 1;
  return common;
}

TEST(RunExperiment, AFinishedResultIsKept) {
  const test::TemporaryFolder folder;
  Experiment experiment = Example(folder.path(), "classic");
  // The settings a run with these options writes.
  const Json settings = {{"method", "classic"},
                         {"size", 16},
                         {"rule", "dir"},
                         {"bits", "8"},
                         {"encoding", "gamma2.2"},
                         {"seed", 0},
                         {"fit_arguments", Json::array()},
                         {"versions", {{"fit", kFitVersion}}}};
  const Json errors = {{"diffuse", 0.25}, {"specular", 0},         {"roughness", 0},
                       {"normal", 0},     {"map_average", 0.0625}, {"render", 0.5}};
  const fs::path file = folder.path() / "procedural_1000000000" / "n02" / "classic.json";
  test::WriteAll(file, Json{{"settings", settings}, {"errors", errors}}.dump());
  std::string said;
  const auto result =
      RunExperiment(experiment, OneThread(), [&](const std::string& text) { said += text; });
  ASSERT_EQ(result.entries.size(), 1u);
  EXPECT_EQ(result.entries[0].errors.render, 0.5);
  EXPECT_THAT(said, HasSubstr("(kept)"));
  // Another truth under the same name, weights that are gone, an older stage, other settings: it
  // has to run again, and no glint-fit knows this option.
  const std::string done = test::ReadAll(file);
  experiment.methods[0].fit_arguments = {"--no-such-option"};
  Json marked = Json::parse(done);
  marked["settings"]["fit_arguments"] = {"--no-such-option"};
  test::WriteAll(file, marked.dump());
  EXPECT_NO_THROW(RunExperiment(experiment, OneThread(), kSilent));
  for (const Json& stale : {Json{{"truth", "xxh3:0"}}, Json{{"models", {{"gone", "xxh3:0"}}}}}) {
    Json json = marked;
    json.update(stale);
    test::WriteAll(file, json.dump());
    EXPECT_THROW(RunExperiment(experiment, OneThread(), kSilent), Error) << stale;
  }
  Json older = marked;
  older["settings"]["versions"]["fit"] = kFitVersion - 1;
  test::WriteAll(file, older.dump());
  EXPECT_THROW(RunExperiment(experiment, OneThread(), kSilent), Error);
  test::WriteAll(file, done);
  EXPECT_THROW(RunExperiment(experiment, OneThread(), kSilent), Error);
  test::WriteAll(file, marked.dump());
  experiment.conditions[0].views.disturbance.light_off_deg = 1;
  EXPECT_THROW(RunExperiment(experiment, OneThread(), kSilent), Error);
}

TEST(ShippedModels, ResultsAreNotKeptBeyondTheirWeights) {
  const test::TemporaryFolder folder;
  test::WriteAll(folder.path() / "models/a.safetensors", "first");
  ::setenv("GLINT_MODELS", (folder.path() / "models").c_str(), 1);
  const auto manifest = [&](const std::string& hash) {
    const Json inputs = {{{"path", "../rectify/manifest.json"}, {"hash", "xxh3:0"}},
                         {{"path", "outside:a.safetensors"}, {"hash", hash}},
                         {{"path", "outside:start.exr"}, {"hash", "xxh3:1"}}};
    const Json json = {{"glint_manifest", 1},       {"stage", "fit"},
                       {"stage_version", 1},        {"inputs", inputs},
                       {"options", Json::object()}, {"outputs", Json::array()},
                       {"data", Json::object()},    {"metrics", Json::object()}};
    test::WriteAll(folder.path() / "manifest.json", json.dump());
    return folder.path() / "manifest.json";
  };
  const std::string hash = HashFile(folder.path() / "models/a.safetensors");
  const Json used = ShippedModels().UsedBy(manifest(hash));
  EXPECT_EQ(used, (Json{{"a.safetensors", hash}}));
  EXPECT_TRUE(ShippedModels().AreStill(used));
  // A file of that name that somebody named: none of ours.
  EXPECT_TRUE(ShippedModels().UsedBy(manifest("xxh3:2")).empty());
  test::WriteAll(folder.path() / "models/a.safetensors", "second");
  EXPECT_FALSE(ShippedModels().AreStill(used));
  fs::remove(folder.path() / "models/a.safetensors");
  EXPECT_FALSE(ShippedModels().AreStill(used));
  ::unsetenv("GLINT_MODELS");
}

TEST(RunExperiment, WrongOptionsAreUserErrors) {
  EXPECT_THROW(NamedMethod("guess", {}, {}), UserError);
  EXPECT_THROW(WithStart(NamedMethod("latent", {}, {}), "luck"), UserError);
  Experiment experiment = Example("/nonexistent", "latent");
  experiment.conditions[0].views.count = 0;
  EXPECT_THROW(RunExperiment(experiment, OneThread(), kSilent), UserError);
  experiment.conditions.clear();
  EXPECT_THROW(RunExperiment(experiment, OneThread(), kSilent), UserError);
}

TEST(ExpandMaterials, FoldersAndRangesAreAllTheirMaterialsSorted) {
  const test::TemporaryFolder folder;
  for (const std::string name : {"wood", "brass"}) {
    fs::create_directories(folder.path() / "all" / name);
    WriteSvbrdf(folder.path() / "all" / name / "svbrdf.exr", MakeMaterial(1, 8, 8),
                ReflectanceConvention::Photograph());
  }
  const std::string all = (folder.path() / "all").string();
  EXPECT_THAT(ExpandMaterials({all, "procedural:9..11", "procedural:wood:3"}),
              ElementsAre(all + "/brass", all + "/wood", "procedural:9", "procedural:10",
                          "procedural:11", "procedural:wood:3"));
  EXPECT_THAT(ExpandMaterials({all + "/wood"}), ElementsAre(all + "/wood"));
  EXPECT_THROW(ExpandMaterials({all, all + "/wood"}), UserError);  // two of one name
  EXPECT_THROW(ExpandMaterials({"procedural:5..3"}), UserError);
  EXPECT_THROW(ExpandMaterials({"procedural:5..x"}), UserError);
  EXPECT_THROW(ExpandMaterials({all + "/none"}), UserError);
}

TEST(CaptureStore, RendersOnceAndGivesEachMethodTheSameFiles) {
  const test::TemporaryFolder folder;
  const MaterialSource material{"m", MakeMaterial(1, 16, 16)};
  ViewSetOptions views;
  views.count = 2;
  const CommonOptions common = OneThread();
  const fs::path first = folder.path() / "latent", second = folder.path() / "classic";
  CaptureStore store(material, views, common);
  store.Provide(first);
  test::WriteAll(second / "glint/fit/manifest.json", "stays");
  store.Provide(second);
  store.Provide(second);
  for (const std::string file : {"photos/view_001.png", "truth/svbrdf.exr", "capture.toml",
                                 "glint/rectify/manifest.json", "glint/rectify/view_001.exr"}) {
    EXPECT_TRUE(fs::equivalent(first / file, second / file)) << file;
  }
  EXPECT_EQ(test::ReadAll(second / "glint/fit/manifest.json"), "stays");
  // Other views in one folder leave the other's files alone.
  const std::string before = test::ReadAll(second / "photos/view_001.png");
  views.exposure_stops = -2;
  CaptureStore(material, views, common).Provide(first);
  EXPECT_EQ(test::ReadAll(second / "photos/view_001.png"), before);
  EXPECT_NE(test::ReadAll(first / "photos/view_001.png"), before);
}

TEST(WithStart, StartsAreWhatTheyAreCalled) {
  const SvbrdfMaps truth = MakeMaterial(4, 64, 64);
  const auto maps = [&](const std::string& start) {
    return WithStart(NamedMethod("refined", {}, {}), start).start(truth);
  };
  EXPECT_EQ(maps("truth").planes, truth.planes);
  const MapErrors rough = CompareMaps(maps("rough"), truth);
  EXPECT_GT(rough.roughness, 0.01);
  EXPECT_EQ(rough.diffuse, 0);
  EXPECT_GT(CompareMaps(maps("random"), truth).average(), 0.02);
  const Method network = WithStart(NamedMethod("latent", {"--a"}, {}), "network");
  EXPECT_EQ(network.name, "network-latent");
  EXPECT_EQ(network.capture, "network-latent");
  EXPECT_THAT(network.fit_arguments, ElementsAre("--a", "--initial-maps", "estimator"));
  EXPECT_EQ(WithStart(NamedMethod("refined", {}, {}), "truth").capture, "truth-latent");
}

}  // namespace
}  // namespace glint
