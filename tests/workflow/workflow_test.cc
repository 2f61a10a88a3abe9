// workflow/Snakefile with stages that compute next to nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "base/files/json.h"
#include "base/stages/stages.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::ReadAll;
using test::WriteAll;
using testing::HasSubstr;

constexpr char kCaptureToml[] =
    "[sample]\nsize_mm = [100, 100]\n[photos]\nfiles = [\"photos/*.jpg\"]\n"
    "[board]\nsquares = [12, 12]\nsquare_mm = 15\nmarker_mm = 11\n";

// The real driver and fake stages, and three captures below captures/: one sound, one whose fit
// fails, one whose description cannot be read.
class WorkflowTest : public testing::Test {
 protected:
  void SetUp() override {
    if (test::RunProgram({"snakemake", "--version"}).code != 0) {
      GTEST_SKIP() << "needs snakemake (apt-get install snakemake)";
    }
    const fs::path bin = folder_ / "bin";
    fs::create_directory(bin);
    for (const char* name :
         {"glint", "glint-run", "glint-status", "glint-estimate", "glint-overview"}) {
      fs::copy_file(fs::path(GLINT_BIN_DIR) / name, bin / name);
    }
    for (const StageKind& stage : Stages()) {
      fs::copy_file(fs::path(GLINT_BIN_DIR) / "fake_stage",
                    bin / ("glint-" + std::string(stage.name)));
    }
    for (const char* name : {"a sound one", "failing"}) {
      WriteAll(capture(name) / "capture.toml", kCaptureToml);
      for (const char* photo : {"a.jpg", "b.jpg"}) {
        WriteAll(capture(name) / "photos" / photo, photo);
      }
    }
    WriteAll(capture("failing") / "capture.toml", std::string(kCaptureToml) + "[fit]\nfail = 4\n");
    WriteAll(capture("unreadable") / "capture.toml", "[sample\n");
  }

  fs::path capture(const std::string& name) const { return folder_ / "captures" / name; }
  fs::path manifest(const std::string& name, const std::string& stage) const {
    return capture(name) / "glint" / stage / "manifest.json";
  }
  std::string page() const { return ReadAll(folder_ / "captures/overview.html"); }

  Outcome Run(const std::vector<std::string>& config = {}) const {
    const fs::path workflow = GLINT_WORKFLOW_DIR;
    std::vector<std::string> command = {"snakemake",
                                        "--snakefile",
                                        (workflow / "Snakefile").string(),
                                        "--profile",
                                        (workflow / "profiles/local").string(),
                                        "--directory",
                                        (folder_ / "captures").string(),
                                        "--config",
                                        "glint=" + (folder_ / "bin/glint").string()};
    command.insert(command.end(), config.begin(), config.end());
    return test::RunProgram(command);
  }

  test::TemporaryFolder folder_;
};

TEST_F(WorkflowTest, ABrokenCaptureFailsAloneAndTheOthersGetWhatRunGives) {
  fs::create_directories(folder_ / "by-run");
  fs::copy(capture("a sound one"), folder_ / "by-run/a sound one", fs::copy_options::recursive);
  const Outcome outcome = Run();
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(fs::exists(manifest("failing", "rectify")));
  EXPECT_FALSE(fs::exists(manifest("failing", "fit")));
  ASSERT_EQ(test::RunProgram({(folder_ / "bin/glint").string(), "run",
                              (folder_ / "by-run/a sound one").string()})
                .code,
            0);
  for (const char* stage : {"calib", "rectify", "fit", "refine", "export", "report"}) {
    EXPECT_EQ(ReadAll(manifest("a sound one", stage)),
              ReadAll(folder_ / "by-run/a sound one/glint" / stage / "manifest.json"))
        << outcome.err;
  }
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("2 failed, 1 done"));
  EXPECT_THAT(html, HasSubstr("failed in fit"));
  EXPECT_THAT(html, HasSubstr("made to fail"));
  EXPECT_THAT(html, HasSubstr("unreadable/capture.toml: line 1"));
  EXPECT_LT(html.find(">unreadable<"), html.find("a sound one"));  // failures first
}

TEST_F(WorkflowTest, ASecondRunDoesWhatIsLeftAndContentDecides) {
  fs::remove_all(capture("unreadable"));
  Run();
  WriteAll(capture("failing") / "capture.toml", kCaptureToml);
  const auto before = fs::last_write_time(manifest("a sound one", "calib"));
  ASSERT_EQ(Run().code, 0);
  EXPECT_THAT(page(), HasSubstr("2 done"));
  EXPECT_EQ(fs::last_write_time(manifest("a sound one", "calib")), before);
  EXPECT_THAT(Run().err, HasSubstr("Nothing to be done"));

  // A photograph replaced by an older file.
  const std::string old_result = ReadAll(manifest("a sound one", "rectify"));
  WriteAll(capture("a sound one") / "photos/a.jpg", "another");
  fs::last_write_time(capture("a sound one") / "photos/a.jpg", before - std::chrono::hours(1000));
  EXPECT_EQ(Run().code, 0);
  EXPECT_NE(ReadAll(manifest("a sound one", "rectify")), old_result);
}

// Maps have 1024² texels, a million.
TEST_F(WorkflowTest, SeveralJobsShareTheRefinementOfALargeCapture) {
  for (const char* name : {"unreadable", "failing"}) fs::remove_all(capture(name));
  const Outcome outcome = Run({"part_texels=400000"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const fs::path targets = capture("a sound one") / "glint/workflow";
  for (const char* part : {"1of3", "2of3", "3of3"}) {
    EXPECT_TRUE(fs::exists(targets / ("refine-" + std::string(part)))) << part;
    EXPECT_FALSE(fs::exists(targets / ("fit-" + std::string(part)))) << part;
  }
  EXPECT_TRUE(fs::exists(manifest("a sound one", "refine")));
  EXPECT_THAT(Run({"part_texels=400000"}).err, HasSubstr("Nothing to be done"));

  // What is up to date as a whole needs no parts.
  const auto before = fs::last_write_time(manifest("a sound one", "refine"));
  EXPECT_EQ(Run({"part_texels=300000"}).code, 0);
  EXPECT_EQ(fs::last_write_time(manifest("a sound one", "refine")), before);

  // All parts again, for other maps.
  WriteAll(capture("a sound one") / "photos/a.jpg", "another");
  EXPECT_EQ(Run({"part_texels=400000"}).code, 0);
  EXPECT_THAT(page(), HasSubstr("1 done"));
}

TEST_F(WorkflowTest, AFailureLeavesTheResultThatIsThere) {
  fs::remove_all(capture("unreadable"));
  WriteAll(capture("failing") / "capture.toml", kCaptureToml);
  ASSERT_EQ(Run().code, 0);
  const std::string result = ReadAll(manifest("failing", "fit"));
  WriteAll(capture("failing") / "capture.toml",
           std::string(kCaptureToml) + "[fit]\ngain = 2\nfail = 4\n");
  EXPECT_EQ(Run().code, 1);
  EXPECT_EQ(ReadAll(manifest("failing", "fit")), result);
  EXPECT_THAT(page(), HasSubstr("1 failed, 1 done"));
}

TEST_F(WorkflowTest, NoCapturesIsAnErrorThatSaysWhereItLooked) {
  fs::remove_all(folder_ / "captures");
  fs::create_directory(folder_ / "captures");
  const Outcome outcome = Run();
  EXPECT_NE(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("found no captures: "));
  EXPECT_THAT(outcome.err, HasSubstr("--directory FOLDER"));
}

}  // namespace
}  // namespace glint
