// `glint run`: which stages run, what it says, failures, and other commands about a capture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/pipeline/driver/run_fixture.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::RunProgram;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST_F(RunTest, ATableTileMakesExportTakeTheRepeatingMaps) {
  SetToml("[tile]\n");
  EXPECT_THAT(RunJson().computed,
              ElementsAre("calib", "rectify", "fit", "refine", "tile", "export", "report"));
  const auto from = [&](const char* stage) {
    return Json::parse(test::ReadAll(manifest(stage)))["options"]["from"];
  };
  EXPECT_EQ(from("tile"), "refine");
  EXPECT_EQ(from("export"), "tile");
  EXPECT_EQ(from("report"), "refine");
  EXPECT_THAT(RunJson().started, testing::IsEmpty());
  SetToml("");
  EXPECT_THAT(RunJson().computed, ElementsAre("export"));
  EXPECT_EQ(from("export"), "refine");
}

TEST_F(RunTest, LeftoversOfAKilledRunAreRemoved) {
  ASSERT_EQ(Glint({"run", capture().string()}).code, 0);
  test::WriteAll(capture() / "glint/build.ninja.tmp1234", "half");
  test::WriteAll(capture() / "glint/.hashes.json.tmp99", "half");
  ASSERT_EQ(Glint({"run", capture().string()}).code, 0);
  EXPECT_FALSE(fs::exists(capture() / "glint/build.ninja.tmp1234"));
  EXPECT_FALSE(fs::exists(capture() / "glint/.hashes.json.tmp99"));
}

TEST_F(RunTest, ANameThatIsNoUtf8IsRefusedAtOnce) {
  test::WriteAll(capture() / "photos" / "caf\xe9.jpg", "photograph");
  const Outcome outcome = Glint({"run", capture().string()});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, testing::HasSubstr("photos.files"));
  EXPECT_THAT(outcome.err, testing::HasSubstr("not UTF-8"));
  EXPECT_FALSE(fs::exists(manifest("calib")));
}

TEST_F(RunTest, OneLineAStageAndWhereThingsAre) {
  const Outcome outcome = Glint({"run", capture().string()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr("maps and materials: " + capture().string()));
  EXPECT_THAT(outcome.out, testing::HasSubstr("glint view"));
  EXPECT_THAT(Glint({"run", capture().string()}).out,
              testing::HasSubstr("up to date: calib, rectify, fit, refine, export, report\n"));
  EXPECT_THAT(Glint({"version"}).out, testing::HasSubstr("glint "));
}

TEST_F(RunTest, ForceComputesTheChosenStages) {
  RunJson();
  EXPECT_THAT(RunJson({"--force", "--from", "refine", "--until", "export"}).computed,
              ElementsAre("refine", "export"));
}

TEST_F(RunTest, UntilStopsAndFromGoesOn) {
  EXPECT_THAT(RunJson({"--until", "fit"}).computed, ElementsAre("calib", "rectify", "fit"));
  EXPECT_THAT(RunJson({"--from", "refine"}).computed, ElementsAre("refine", "export", "report"));
}

TEST_F(RunTest, FromWithoutEarlierResultsSaysSo) {
  const Outcome outcome = Glint({"run", capture().string(), "--from", "fit"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("rectify/manifest.json: found no such file; "));
  EXPECT_FALSE(fs::exists(capture() / "glint"));
}

TEST_F(RunTest, HeldOutPhotographsReachFitAndRefineOnly) {
  RunJson();
  EXPECT_THAT(RunJson({"--exclude", "a.jpg"}).computed,
              ElementsAre("fit", "refine", "export", "report"));
  const Json options = Json::parse(test::ReadAll(manifest("refine")))["options"];
  EXPECT_EQ(options["exclude"], Json::array({"a.jpg"}));
  EXPECT_THAT(RunJson({"--exclude", "a.jpg"}).started, IsEmpty());
}

TEST_F(RunTest, MethodsWithoutRefinementLeaveItOut) {
  RunJson({"--method", "classic"});
  EXPECT_FALSE(fs::exists(manifest("refine")));
  EXPECT_EQ(Json::parse(test::ReadAll(manifest("fit")))["options"]["method"], "classic");
  EXPECT_EQ(Json::parse(test::ReadAll(manifest("export")))["options"]["from"], "fit");
  const Outcome outcome =
      Glint({"run", capture().string(), "--method", "latent", "--until", "refine"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("found 'refine', which this run does not have"));
}

TEST_F(RunTest, QuickEstimatesAndARunAfterItFits) {
  EXPECT_THAT(RunJson({"--quick"}).computed,
              ElementsAre("calib", "rectify", "fit", "export", "report"));
  EXPECT_EQ(Json::parse(test::ReadAll(manifest("fit")))["options"]["method"], "initial");
  EXPECT_THAT(RunJson({"--method", "initial"}).started, IsEmpty());
  EXPECT_THAT(RunJson().computed, ElementsAre("fit", "refine", "export", "report"));
  const Outcome both = Glint({"run", capture().string(), "--quick", "--method", "latent"});
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, HasSubstr("--quick: found with --method latent; give one of the two"));
}

TEST_F(RunTest, AnImportedCaptureStartsAtFit) {
  RunJson();
  const fs::path imported = folder_.path() / "imported";
  test::WriteAll(imported / "capture.toml", "[sample]\nsize_mm = [10, 10]\n");
  const Outcome missing = Glint({"run", imported.string()});
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("glint import"));
  fs::create_directories(imported / "glint");
  fs::copy(capture() / "glint/rectify", imported / "glint/rectify");
  const Outcome outcome = Glint({"run", imported.string(), "--json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Json::parse(outcome.out)["started"],
            Json::array({"fit", "refine", "export", "report"}));
}

TEST_F(RunTest, AFailingStagesExitCodeAndMessagePassThroughOnce) {
  RunJson();
  const std::string before = test::ReadAll(manifest("refine"));
  for (const int code : {1, 2, 3}) {
    SetToml("[refine]\ngain = 3.0\nfail = " + std::to_string(code) + "\n");
    const Outcome outcome = Glint({"run", capture().string()});
    EXPECT_EQ(outcome.code, code);
    EXPECT_THAT(outcome.err, HasSubstr("glint-refine: error: " + capture().string() +
                                       "/capture.toml: made to fail\n"));
    EXPECT_EQ(outcome.err.find("error"), outcome.err.rfind("error")) << outcome.err;
    EXPECT_THAT(outcome.out + outcome.err, Not(HasSubstr("ninja")));
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(test::ReadAll(manifest("refine")), before);
    EXPECT_EQ(test::ReadAll(capture() / "glint/report/manifest.json").empty(), false);
  }
}

TEST_F(RunTest, AStageEndedBySignalIsNamed) {
  SetToml("[fit]\ndie = true\n");
  const Outcome outcome = Glint({"run", capture().string()});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("glint-fit was ended by signal 9"));
  SetToml("");
  EXPECT_THAT(RunJson().computed, ElementsAre("fit", "refine", "export", "report"));
}

TEST_F(RunTest, KillingTheRunAloneEndsItsStagesAndTheNextRunGoesOn) {
  SetToml("[fit]\nsleep = 20\n");
  const fs::path out = folder_.path() / "out", err = folder_.path() / "err";
  const pid_t pid =
      test::Start({folder_.path() / "bin/glint", "run", capture().string()}, out, err);
  while (!fs::exists(capture() / "glint/.fit.new/result.txt")) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ::kill(pid, SIGKILL);
  EXPECT_EQ(test::WaitFor(pid), 128 + SIGKILL);
  SetToml("");
  EXPECT_THAT(RunJson().computed, ElementsAre("fit", "refine", "export", "report"));
}

TEST_F(RunTest, TwoRunsAtOnceAreRefused) {
  SetToml("[fit]\nsleep = 4\n");
  const fs::path out = folder_.path() / "out", err = folder_.path() / "err";
  const pid_t pid =
      test::Start({folder_.path() / "bin/glint", "run", capture().string()}, out, err);
  while (!fs::exists(capture() / "glint/.fit.new/result.txt")) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const Outcome outcome = Glint({"run", capture().string()});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("found a lock held by another process (another glint run"));
  ::kill(-pid, SIGKILL);
  test::WaitFor(pid);
}

TEST_F(RunTest, UnknownStagesAndMissingCapturesAreNamed) {
  const Outcome stage = Glint({"run", capture().string(), "--until", "bake"});
  EXPECT_EQ(stage.code, 2);
  EXPECT_THAT(stage.err, HasSubstr("--until: found the unknown stage 'bake'; use one of: calib, "));
  const Outcome missing = Glint({"run", (folder_.path() / "nowhere").string()});
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("nowhere: found no such folder; "));
  const Outcome order = Glint({"run", capture().string(), "--from", "fit", "--until", "calib"});
  EXPECT_EQ(order.code, 2);
}

TEST_F(RunTest, WithoutNinjaSaysHowToInstallIt) {
  const Outcome outcome = RunProgram({folder_.path() / "bin/glint-run", capture()},
                                     [] { ::setenv("PATH", "/nowhere", 1); });
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("apt-get install ninja-build"));
}

TEST_F(RunTest, AwkwardFileNamesAreFine) {
  for (const char* name :
       {"a b.jpg", "c$d.jpg", "e:f.jpg", "g'h\"i.jpg", "k#l.jpg", "Wäsche.jpg", "it's $x;y.jpg"}) {
    test::WriteAll(capture() / "photos" / name, name);
  }
  EXPECT_EQ(RunJson({"--exclude", "it's $x;y"}).computed.size(), 6u);
  EXPECT_EQ(Json::parse(test::ReadAll(manifest("fit")))["options"]["exclude"][0], "it's $x;y");
  EXPECT_THAT(RunJson({"--exclude", "it's $x;y"}).started, IsEmpty());
}

TEST_F(RunTest, GlintListsAndSuggestsVerbs) {
  const Outcome help = Glint({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out, HasSubstr("  run        run every stage that is out of date\n"));
  const Outcome typo = Glint({"ran"});
  EXPECT_EQ(typo.code, 2);
  EXPECT_THAT(typo.err, HasSubstr("unknown verb 'ran'; did you mean: glint run"));
  EXPECT_EQ(Glint({"help", "run"}).code, 0);
}

TEST_F(RunTest, ViewOpensThePageOfAResult) {
  const Outcome none = Glint({"view", capture().string()});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("found no page; make it with: glint run"));
  test::WriteAll(capture() / "glint/report/index.html", "x");
  const Outcome page = Glint({"view", capture().string(), "--print"});
  EXPECT_EQ(page.code, 0) << page.err;
  EXPECT_THAT(page.out, HasSubstr("glint/report/index.html"));
}

TEST_F(RunTest, APhotographWithACommaInItsNameCanBeExcluded) {
  test::WriteAll(capture() / "photos" / "a,b.jpg", "x");
  EXPECT_THAT(RunJson({"--exclude", "a,b.jpg"}).computed, Contains("fit"));
  const Outcome outcome = Glint({"run", capture().string(), "--exclude", "a,c.jpg"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--exclude: found no photograph named 'c.jpg'"));
}

TEST_F(RunTest, AMisspeltExcludeIsAnErrorAtOnce) {
  const Outcome outcome = Glint({"run", capture().string(), "--exclude", "IMG_9999"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--exclude: found no photograph named 'IMG_9999'"));
  EXPECT_FALSE(fs::exists(capture() / "glint/calib"));
}

TEST_F(RunTest, WhatNeedsMoreMemoryThanAllowedIsRefusedBeforeAnyStage) {
  const Outcome outcome = Glint({"run", capture().string(), "--memory", "0.3"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("capture.toml: glint-"));
  EXPECT_THAT(outcome.err, HasSubstr("more than the 300 MB that it may use (--memory)"));
  EXPECT_FALSE(fs::exists(capture() / "glint/calib"));
  EXPECT_EQ(RunJson({"--memory", "8"}).computed.size(), 6u);
}

TEST_F(RunTest, AnEstimateSumsTimeAndTakesTheLargestMemory) {
  const Outcome outcome = Glint({"estimate", capture().string(), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["photographs"], 2);
  double seconds = 0, most = 0;
  std::vector<std::string> stages;
  for (const Json& stage : json["stages"]) {
    stages.push_back(stage["stage"]);
    seconds += stage["seconds"].get<double>();
    most = std::max(most, stage["memory_bytes"].get<double>());
  }
  EXPECT_THAT(stages, ElementsAre("calib", "rectify", "fit", "refine", "export", "report"));
  EXPECT_NEAR(json["seconds"], seconds, 1e-9);
  EXPECT_EQ(json["memory_bytes"], most);
  EXPECT_THAT(Glint({"estimate", capture().string()}).out, HasSubstr("\nall "));
}

// A run killed while its edge was being loaded left the edge to work on, under the run's lock.
TEST_F(RunTest, AnEdgeWhoseNinjaWasKilledBeforeItBeganDoesNothing) {
  const fs::path made = folder_.path() / "made";
  const auto edge_under = [&](pid_t ninja) {
    return RunProgram({(folder_.path() / "bin/glint").string(), "--edge", "calib", "touch"}, [&] {
      ::setenv("GLINT_RUN_CAPTURE", made.c_str(), 1);
      ::setenv("GLINT_RUN_NINJA", std::to_string(ninja).c_str(), 1);
    });
  };
  EXPECT_EQ(edge_under(1).code, 128 + SIGKILL);
  EXPECT_FALSE(fs::exists(made));
  EXPECT_EQ(edge_under(::getpid()).code, 0);
  EXPECT_TRUE(fs::exists(made));
}

}  // namespace
}  // namespace glint
