// What makes results stale, and what does not: content decides.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "tests/pipeline/driver/run_fixture.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::RunProgram;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

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

TEST_F(RunTest, WhatWasGivenToAStageOnItsCommandLineIsKept) {
  RunJson();
  const std::string refine = (folder_.path() / "bin/glint-refine").string();
  const auto gain = [&] {
    return Json::parse(test::ReadAll(manifest("refine")))["options"]["gain"].get<double>();
  };
  EXPECT_EQ(test::RunProgram({refine, capture().string(), "--gain", "2.5"}).code, 0);
  EXPECT_THAT(RunJson().computed, ElementsAre("export", "report"));
  EXPECT_EQ(gain(), 2.5);
  // Also where the stage is computed anew, more than once.
  for (const char* bytes : {"changed", "changed again"}) {
    test::WriteAll(capture() / "photos/a.jpg", bytes);
    const Outcome run = Glint({"run", capture().string()});
    EXPECT_THAT(run.err, HasSubstr("refine keeps --gain=2.5")) << run.err;
    EXPECT_EQ(gain(), 2.5);
  }
  EXPECT_THAT(Glint({"status", capture().string()}).out, testing::Not(HasSubstr("stale")));
  // capture.toml wins where it names the option, and the stage without it forgets it.
  SetToml("[refine]\ngain = 3.0\n");
  EXPECT_THAT(Glint({"run", capture().string()}).err,
              HasSubstr("[refine] gain in capture.toml overrides --gain=2.5"));
  EXPECT_EQ(gain(), 3);
  SetToml("");
  EXPECT_EQ(test::RunProgram({refine, capture().string(), "--gain", "2"}).code, 0);
  EXPECT_EQ(test::RunProgram({refine, capture().string()}).code, 0);
  RunJson();
  EXPECT_EQ(gain(), 1);
}

// They hold for that run alone, as those that `glint run` gives to its stages always did.
TEST_F(RunTest, WhatWasGivenToARunIsNotKept) {
  RunJson({"--exclude", "a.jpg"});
  EXPECT_THAT(RunJson().computed, ElementsAre("fit", "refine", "export", "report"));
  EXPECT_TRUE(Json::parse(test::ReadAll(manifest("refine")))["options"]["exclude"].empty());
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

TEST_F(RunTest, DryRunAndStatusSayWhyAndWriteNothing) {
  const Outcome nothing_yet = Glint({"run", capture().string(), "--dry-run"});
  EXPECT_EQ(Glint({"run", capture().string(), "--status"}).out, nothing_yet.out);
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

}  // namespace
}  // namespace glint
