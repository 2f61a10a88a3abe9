#include "pipeline/driver/stage_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/stages/stages.h"

namespace glint {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

Capture OfPhotographs() {
  Capture capture;
  capture.has_board = true;
  capture.photos = {"photos/a.jpg", "photos/b.jpg"};
  capture.board_photos = {"board/c.jpg"};
  capture.board_file = "board.json";
  return capture;
}

// "fit <- rectify: --method latent"
std::vector<std::string> InWords(const std::vector<StageStep>& steps) {
  std::vector<std::string> lines;
  for (const StageStep& step : steps) {
    std::string line = step.stage + " <-";
    for (const std::string& earlier : step.waits_for) line += " " + earlier;
    if (!step.arguments.empty()) line += ":";
    for (const std::string& argument : step.arguments) line += " " + argument;
    lines.push_back(line);
  }
  return lines;
}

TEST(StageGraph, ARefinedCaptureReadsEachStagesResultOnce) {
  EXPECT_THAT(InWords(StageSteps(OfPhotographs(), {})),
              ElementsAre("calib <-", "rectify <- calib", "fit <- rectify", "refine <- rectify fit",
                          "export <- refine: --from refine",
                          "report <- calib rectify fit refine export: --from refine"));
}

TEST(StageGraph, TiledMapsAreExportedAndWholeOnesShown) {
  Capture capture = OfPhotographs();
  capture.tiles = true;
  RunChoices choices;
  choices.method = "classic";
  choices.exclude = {"a"};
  choices.seed = 7;
  EXPECT_THAT(
      InWords(StageSteps(capture, choices)),
      ElementsAre("calib <-: --seed 7", "rectify <- calib: --seed 7",
                  "fit <- rectify: --method classic --exclude a --seed 7",
                  "tile <- fit: --from fit --seed 7", "export <- tile: --from tile --seed 7",
                  "report <- calib rectify fit tile export: --from fit --seed 7"));
}

TEST(StageGraph, AnImportedCaptureBeginsWithTheViewsThatAreThere) {
  Capture capture;
  ASSERT_TRUE(capture.imported());
  RunChoices choices;
  choices.method = "initial";
  choices.views = {"b"};
  EXPECT_THAT(InWords(StageSteps(capture, choices)),
              ElementsAre("fit <- rectify: --method initial --views b", "export <- fit: --from fit",
                          "report <- rectify fit export: --from fit"));
}

TEST(StageGraph, AStageBetweenRectifyAndFitIsWaitedForWhereItRuns) {
  for (const Runs runs : {Runs::kAlways, Runs::kFromPhotographs}) {
    std::vector<StageKind> stages(Stages().begin(), Stages().end());
    stages.insert(stages.begin() + 2, {.name = "clean",
                                       .summary = "",
                                       .cost = {},
                                       .runs = runs,
                                       .reads = {.views = true},
                                       .gives = Gives::kViews});
    const auto first_steps = [&](const Capture& capture, size_t count) {
      std::vector<std::string> steps = InWords(StageSteps(capture, {}, stages));
      steps.resize(count);
      return steps;
    };
    EXPECT_THAT(first_steps(OfPhotographs(), 5),
                ElementsAre("calib <-", "rectify <- calib", "clean <- rectify", "fit <- clean",
                            "refine <- clean fit"));
    if (runs == Runs::kAlways) {
      EXPECT_THAT(first_steps({}, 2), ElementsAre("clean <- rectify", "fit <- clean"));
    } else {
      EXPECT_THAT(first_steps({}, 2), ElementsAre("fit <- rectify", "refine <- rectify fit"));
    }
  }
}

TEST(StageGraph, FilesAreInputsOfTheStagesThatReadThem) {
  const std::vector<StageStep> steps = StageSteps(OfPhotographs(), {});
  EXPECT_THAT(steps[0].inputs, ElementsAre("capture.toml", "photos/a.jpg", "photos/b.jpg",
                                           "board/c.jpg", "board.json"));
  EXPECT_THAT(steps[1].inputs, ElementsAre("capture.toml", "photos/a.jpg", "photos/b.jpg",
                                           "glint/calib/manifest.json"));
  EXPECT_THAT(steps[3].inputs, ElementsAre("capture.toml", "glint/rectify/manifest.json",
                                           "glint/fit/manifest.json"));
}

// Whatever row is added to the list: nothing waits for what comes later or does not run.
TEST(StageGraph, StagesWaitForEarlierOnesAlone) {
  for (const bool tiles : {false, true}) {
    for (const char* method : {"", "refined", "latent", "classic", "initial"}) {
      Capture capture = OfPhotographs();
      capture.tiles = tiles;
      std::vector<std::string> done;
      RunChoices choices;
      choices.method = method;
      for (const StageStep& step : StageSteps(capture, choices)) {
        for (const std::string& earlier : step.waits_for) EXPECT_THAT(done, Contains(earlier));
        EXPECT_EQ(step.waits_for.empty(), step.stage == "calib");
        done.push_back(step.stage);
      }
      EXPECT_EQ(done.back(), Stages().back().name);
    }
  }
}

}  // namespace
}  // namespace glint
