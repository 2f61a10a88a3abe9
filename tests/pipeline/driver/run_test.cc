// `glint run`, `status` and `init` with stages that compute next to nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "pipeline/contract/image.h"
#include "pipeline/contract/json.h"
#include "tests/support/process.h"

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

constexpr char kCaptureToml[] =
    "[sample]\nsize_mm = [100, 100]\n[photos]\nfiles = [\"photos/*.jpg\"]\n"
    "[board]\nsquares = [12, 12]\nsquare_mm = 15\nmarker_mm = 11\n";

// A folder of programs (the real driver, fake stages) and a capture.
class RunTest : public testing::Test {
 protected:
  RunTest() {
    const fs::path bin = folder_.path() / "bin";
    fs::create_directory(bin);
    for (const char* name : {"glint", "glint-run", "glint-status", "glint-init", "glint-verify",
                             "glint-view", "glint-estimate"}) {
      fs::copy_file(fs::path(GLINT_BIN_DIR) / name, bin / name);
    }
    for (const char* stage : {"calib", "rectify", "fit", "refine", "tile", "export", "report"}) {
      fs::copy_file(fs::path(GLINT_BIN_DIR) / "fake_stage", bin / ("glint-" + std::string(stage)));
    }
    SetToml("");
    for (const char* photo : {"a.jpg", "b.jpg"})
      test::WriteAll(capture() / "photos" / photo, photo);
  }

  fs::path capture() const { return folder_.path() / "wood"; }
  fs::path manifest(const std::string& stage) const {
    return capture() / "glint" / stage / "manifest.json";
  }
  void SetToml(const std::string& more) const {
    test::WriteAll(capture() / "capture.toml", kCaptureToml + more);
  }
  Outcome Glint(std::vector<std::string> words) const {
    words.insert(words.begin(), (folder_.path() / "bin/glint").string());
    return RunProgram(words);
  }
  // Stages that a run with these further arguments computes, and that it starts.
  struct Ran {
    std::vector<std::string> computed, started;
  };
  Ran RunJson(std::vector<std::string> words = {}) const {
    words.insert(words.begin(), {"run", capture().string(), "--json"});
    const Outcome outcome = Glint(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    Ran ran;
    const Json json = Json::parse(outcome.out, nullptr, false);
    if (!json.is_object()) {
      ADD_FAILURE() << outcome.out << outcome.err;
      return ran;
    }
    for (const Json& stage : json["stages"]) {
      if (stage["state"] == "computed") ran.computed.push_back(stage["stage"]);
    }
    ran.started = json["started"].get<std::vector<std::string>>();
    return ran;
  }

  test::TemporaryFolder folder_;
};

TEST_F(RunTest, InitDescribesOnePhotographFromAbove) {
  const fs::path folder = folder_.path() / "single";
  fs::create_directories(folder);
  WritePng(folder / "a.png", Image(4, 3, {"R", "G", "B"}));
  const Outcome vague = Glint({"init", folder.string(), "--single"});
  EXPECT_EQ(vague.code, 2);
  EXPECT_THAT(vague.err, testing::HasSubstr("--width-mm"));
  const Outcome outcome = Glint({"init", folder.string(), "--single", "--width-mm", "120"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string text = test::ReadAll(folder / "capture.toml");
  EXPECT_THAT(text, testing::HasSubstr("size_mm = [81, 81]"));
  EXPECT_THAT(text, testing::HasSubstr("poses = \"above\""));
  EXPECT_THAT(text, testing::HasSubstr("picture_width_mm = 120"));
  const fs::path several = folder_.path() / "several";
  fs::create_directories(several);
  for (const char* name : {"a.png", "b.png"}) {
    WritePng(several / name, Image(4, 3, {"R", "G", "B"}));
  }
  const Outcome two = Glint({"init", several.string(), "--single", "--width-mm", "120"});
  EXPECT_EQ(two.code, 2);
  EXPECT_THAT(two.err, testing::HasSubstr("found 2 photographs"));
}

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
  EXPECT_THAT(outcome.err, testing::HasSubstr("no UTF-8"));
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

TEST_F(RunTest, ASecondRunStartsNoStage) {
  EXPECT_THAT(RunJson().computed,
              ElementsAre("calib", "rectify", "fit", "refine", "export", "report"));
  EXPECT_THAT(RunJson().started, IsEmpty());
}

TEST_F(RunTest, ASecondRunFromAnotherFolderUnderAnotherNameStartsNoStage) {
  RunJson();
  const fs::path moved = folder_.path() / "moved";
  fs::rename(capture(), moved);
  const Outcome outcome =
      RunProgram({"/bin/sh", "-c", "cd '" + moved.string() + "' && ../bin/glint run --json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(Json::parse(outcome.out)["started"].empty()) << outcome.out;
}

TEST_F(RunTest, AChangedOptionComputesItsStageAndLaterOnesOnly) {
  RunJson();
  SetToml("[refine]\ngain = 2.0\n");
  EXPECT_THAT(RunJson().computed, ElementsAre("refine", "export", "report"));
  EXPECT_THAT(RunJson().started, IsEmpty());
}

TEST_F(RunTest, ATouchedPhotographComputesNothing) {
  RunJson();
  fs::last_write_time(capture() / "photos/a.jpg", fs::file_time_type::clock::now());
  EXPECT_THAT(RunJson().computed, IsEmpty());
  EXPECT_THAT(RunJson().started, IsEmpty());
}

TEST_F(RunTest, AChangedPhotographComputesAll) {
  RunJson();
  test::WriteAll(capture() / "photos/a.jpg", "other");
  EXPECT_EQ(RunJson().computed.size(), 6u);
}

// Hashes decide, not times: `mv`, `cp -p` and `rsync -a` bring old ones along.
TEST_F(RunTest, WhatIsReplacedByAnOlderFileIsNoticed) {
  RunJson();
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1000);
  test::WriteAll(capture() / "photos/a.jpg", "older");
  fs::last_write_time(capture() / "photos/a.jpg", long_ago);
  EXPECT_EQ(RunJson().computed.size(), 6u);
  EXPECT_THAT(RunJson().started, IsEmpty());
  SetToml("[refine]\ngain = 2.0\n");
  fs::last_write_time(capture() / "capture.toml", long_ago);
  EXPECT_THAT(RunJson().computed, ElementsAre("refine", "export", "report"));
  EXPECT_THAT(RunJson().started, IsEmpty());
}

TEST_F(RunTest, AFlippedByteInAnOutputThatKeepsItsTimeIsNoticed) {
  RunJson();
  const fs::path output = capture() / "glint/fit/result.txt";
  const auto time = fs::last_write_time(output);
  std::string bytes = test::ReadAll(output);
  bytes[0] ^= 1;
  test::WriteAll(output, bytes);
  fs::last_write_time(output, time);
  EXPECT_THAT(RunJson().computed, testing::Contains("fit"));
  EXPECT_THAT(RunJson().started, IsEmpty());
}

TEST_F(RunTest, ADigitChangedInAManifestIsNoticed) {
  RunJson();
  std::string text = test::ReadAll(manifest("calib"));
  const size_t at = text.find("\"stage_version\": ") + 17;
  text[at] = text[at] == '9' ? '8' : '9';
  test::WriteAll(manifest("calib"), text);
  fs::last_write_time(manifest("calib"), fs::file_time_type::clock::now() - std::chrono::hours(1));
  EXPECT_THAT(RunJson().computed, testing::Contains("calib"));
}

TEST_F(RunTest, VerifyNamesWhatHasChanged) {
  RunJson();
  EXPECT_EQ(Glint({"verify", capture().string()}).code, 0);
  test::WriteAll(capture() / "photos/a.jpg", "other");
  test::WriteAll(capture() / "glint/fit/result.txt", "other");
  fs::remove(capture() / "glint/export/result.txt");
  std::string text = test::ReadAll(manifest("rectify"));
  text.insert(text.find("\"stage_version\": ") + 17, "1");
  test::WriteAll(manifest("rectify"), text);
  const Outcome outcome = Glint({"verify", capture().string()});
  EXPECT_EQ(outcome.code, 1);
  for (const char* said : {"a.jpg has changed", "output result.txt has changed",
                           "output result.txt is missing", "changed after it was written"}) {
    EXPECT_THAT(outcome.out, HasSubstr(said));
  }
  EXPECT_EQ(Glint({"verify", (folder_.path() / "nothing").string()}).code, 2);
}

TEST_F(RunTest, AnAddedOrRemovedPhotographIsNoticed) {
  RunJson();
  test::WriteAll(capture() / "photos/c.jpg", "c");
  // Older than every result: the list of photographs itself has to be compared.
  fs::last_write_time(capture() / "photos/c.jpg",
                      fs::file_time_type::clock::now() - std::chrono::hours(1));
  EXPECT_EQ(RunJson().computed.size(), 6u);
  fs::remove(capture() / "photos/c.jpg");
  EXPECT_EQ(RunJson().computed.size(), 6u);
}

TEST_F(RunTest, AFileThatOnlyTheLastResultNamesIsWatched) {
  test::WriteAll(capture() / "weights", "1");
  RunJson();
  test::WriteAll(capture() / "weights", "2");
  EXPECT_THAT(RunJson().computed, ElementsAre("fit", "refine", "export", "report"));
}

TEST_F(RunTest, AFileOutsideTheCaptureIsWatched) {
  RunJson();
  const fs::path weights = folder_.path() / "weights";
  test::WriteAll(weights, "1");
  test::WriteAll(capture() / "glint/fit/run.json", Json({{"outside", {weights}}}).dump());
  EXPECT_THAT(RunJson().started, testing::Contains("fit"));
  EXPECT_THAT(RunJson().started, IsEmpty());
  fs::remove(weights);
  EXPECT_THAT(RunJson().started, testing::Contains("fit"));
}

TEST_F(RunTest, ADamagedOrRemovedOutputIsMadeAnew) {
  RunJson();
  fs::remove(capture() / "glint/fit/result.txt");
  EXPECT_THAT(RunJson().computed, testing::Contains("fit"));
  EXPECT_TRUE(fs::exists(capture() / "glint/fit/result.txt"));
  test::WriteAll(capture() / "glint/rectify/result.txt", "damaged");
  EXPECT_THAT(RunJson().computed, testing::Contains("rectify"));
  test::WriteAll(manifest("refine"), "{}");
  EXPECT_THAT(RunJson().computed, testing::Contains("refine"));
  EXPECT_THAT(RunJson().started, IsEmpty());
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
  EXPECT_EQ(Json::parse(test::ReadAll(manifest("fit")))["options"]["method"], "start");
  EXPECT_THAT(RunJson({"--method", "start"}).started, IsEmpty());
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

TEST_F(RunTest, DryRunAndStatusSayWhyAndWriteNothing) {
  const Outcome nothing_yet = Glint({"run", capture().string(), "--dry-run"});
  EXPECT_EQ(nothing_yet.code, 0) << nothing_yet.err;
  EXPECT_THAT(nothing_yet.out, HasSubstr("calib    would run  there is no result yet"));
  EXPECT_FALSE(fs::exists(capture() / "glint"));
  RunJson({"--exclude", "a.jpg"});
  SetToml("[refine]\ngain = 2.5\n");
  const Outcome status = Glint({"status", capture().string()});
  EXPECT_EQ(status.code, 0) << status.err;
  EXPECT_THAT(status.out, HasSubstr("fit      up to date"));
  EXPECT_THAT(status.out, HasSubstr("option gain was 1.0 and is 2.5"));
  EXPECT_THAT(status.out, HasSubstr("it reads the result of refine, which is stale"));
  const Outcome json = Glint({"status", capture().string(), "--json"});
  EXPECT_EQ(Json::parse(json.out)["stages"][3]["state"], "stale");
}

TEST_F(RunTest, ThreadsNeverMakeAResultStale) {
  RunJson({"-j", "2"});
  EXPECT_THAT(RunJson({"-j", "1"}).started, IsEmpty());
}

TEST_F(RunTest, GlintListsAndSuggestsVerbs) {
  const Outcome help = Glint({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out, HasSubstr("  run       run every stage that is out of date\n"));
  const Outcome typo = Glint({"ran"});
  EXPECT_EQ(typo.code, 2);
  EXPECT_THAT(typo.err, HasSubstr("found the unknown verb 'ran'; did you mean: glint run"));
  EXPECT_EQ(Glint({"help", "run"}).code, 0);
}

TEST_F(RunTest, InitDescribesWhatIsInTheFolderAndKeepsAnExistingFile) {
  const fs::path folder = folder_.path() / "new";
  test::WriteAll(folder / "photos/1.JPG", "x");
  test::WriteAll(folder / "photos/2.png", "x");
  test::WriteAll(folder / "board/1.jpg", "x");
  const Outcome first =
      Glint({"init", folder.string(), "--square-mm", "20", "--sample-mm", "90,80"});
  EXPECT_EQ(first.code, 0) << first.err;
  const std::string text = test::ReadAll(folder / "capture.toml");
  EXPECT_THAT(text, HasSubstr("files = [\"photos/*.jpg\", \"photos/*.png\"]"));
  EXPECT_THAT(text, HasSubstr("photos = [\"board/*.jpg\"]"));
  EXPECT_THAT(text, HasSubstr("size_mm = [90, 80]"));
  EXPECT_THAT(text, HasSubstr("window = [3, 5, 7, 7]"));
  const Outcome plan = Glint({"run", folder.string(), "--dry-run"});
  EXPECT_EQ(plan.code, 0) << plan.err;
  const Outcome second = Glint({"init", folder.string()});
  EXPECT_EQ(second.code, 2);
  EXPECT_EQ(test::ReadAll(folder / "capture.toml"), text);
}

TEST_F(RunTest, InitWithoutABoardTakesCamerasFromColmap) {
  const fs::path folder = folder_.path() / "open";
  test::WriteAll(folder / "photos/1.jpg", "x");
  ASSERT_EQ(Glint({"init", folder.string(), "--board", "none"}).code, 0);
  const std::string text = test::ReadAll(folder / "capture.toml");
  EXPECT_THAT(text, HasSubstr("poses = \"colmap\""));
  EXPECT_THAT(text, HasSubstr("size_mm = [100, 100]"));
  EXPECT_THAT(text, HasSubstr("\n[poses]"));
  EXPECT_THAT(text, Not(HasSubstr("[board]")));
  const Outcome plan = Glint({"run", folder.string(), "--dry-run"});
  EXPECT_EQ(plan.code, 0) << plan.err;
  const fs::path small = folder_.path() / "small";
  ASSERT_EQ(
      Glint({"init", small.string(), "--create", "--board", "none", "--sample-mm", "60x40"}).code,
      0);
  EXPECT_THAT(test::ReadAll(small / "capture.toml"), HasSubstr("size_mm = [60, 40]"));
}

TEST_F(RunTest, InitFindsPhotographsBeneathTheFolder) {
  const fs::path folder = folder_.path() / "wood & co";
  test::WriteAll(folder / "DCIM 1/1.JPG", "x");
  test::WriteAll(folder / "DCIM 1/2.jpg", "x");
  test::WriteAll(folder / "board/1.jpg", "x");
  test::WriteAll(folder / "board/2.jpg", "x");
  test::WriteAll(folder / "board/3.jpg", "x");
  test::WriteAll(folder / "screenshot.png", "x");
  ASSERT_EQ(Glint({"init", folder.string()}).code, 0);
  const std::string text = test::ReadAll(folder / "capture.toml");
  EXPECT_THAT(text, HasSubstr("files = [\"DCIM 1/*.jpg\"]"));
  EXPECT_THAT(text, HasSubstr("name = \"wood___co\""));
  const fs::path flat = folder_.path() / "flat";
  test::WriteAll(flat / "1.jpg", "x");
  ASSERT_EQ(Glint({"init", flat.string()}).code, 0);
  EXPECT_THAT(test::ReadAll(flat / "capture.toml"), HasSubstr("files = [\"*.jpg\"]"));
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

TEST_F(RunTest, InitDoesNotMakeAMistypedFolder) {
  const fs::path folder = folder_.path() / "wod";
  const Outcome outcome = Glint({"init", folder.string()});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no such folder; check its name, or make it with --create"));
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(RunTest, InitRefusesASampleLargerThanTheWindow) {
  const fs::path folder = folder_.path() / "new";
  fs::create_directories(folder);
  const Outcome outcome = Glint({"init", folder.string(), "--sample-mm", "100x140"});
  EXPECT_EQ(outcome.code, 2);  // seven squares of 15 mm are left out
  EXPECT_THAT(outcome.err, HasSubstr("--sample-mm: found [100, 140], which the board's window of "
                                     "[105, 105] does not show whole"));
  EXPECT_FALSE(fs::exists(folder / "capture.toml"));
  const Outcome wrong = Glint({"init", folder.string(), "--sample-mm", "100xabc"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("'100xabc' is no number"));
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

TEST_F(RunTest, InitRefusesABoardThatCannotBe) {
  const fs::path folder = folder_.path() / "new";
  fs::create_directories(folder);
  const Outcome outcome = Glint({"init", folder.string(), "--marker-mm", "30"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("marker_mm"));
  EXPECT_FALSE(fs::exists(folder / "capture.toml"));
}

}  // namespace
}  // namespace glint
