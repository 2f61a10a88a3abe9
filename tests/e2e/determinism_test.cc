// Same inputs, same bytes; and nothing is computed twice.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

#include "base/files/json.h"
#include "base/formats/svbrdf_file.h"
#include "tests/e2e/capture_fixture.h"

namespace glint::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

class DeterminismTest : public CaptureTest {
 protected:
  struct Ran {
    std::vector<std::string> computed, started;
  };
  Ran RunJson(std::vector<std::string> more = {}) const {
    more.push_back("--json");
    const Outcome outcome = RunCapture(more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    Ran ran;
    if (outcome.code != 0) return ran;
    const Json json = Json::parse(outcome.out);
    for (const Json& stage : json["stages"]) {
      if (stage["state"] == "computed") ran.computed.push_back(stage["stage"]);
    }
    ran.started = json["started"].get<std::vector<std::string>>();
    return ran;
  }
};

TEST_F(DeterminismTest, OneAndTwoThreadsInTwoFoldersGiveTheSameBytes) {
  const fs::path other = folder() / "another, longer name" / "wood";
  fs::create_directories(other.parent_path());
  CopyCapture(finished(), other);
  fs::remove_all(other / "glint");
  fs::remove_all(capture() / "glint");
  const Outcome one = Glint({"run", other.string(), "-j", "1"});
  ASSERT_EQ(one.code, 0) << one.err;
  const Outcome two = RunCapture({"-j", "2"});
  ASSERT_EQ(two.code, 0) << two.err;
  const Tree results = Results(capture());
  EXPECT_GE(results.size(), 12u);
  EXPECT_EQ(Differences(results, Results(other)), "");
  EXPECT_EQ(Differences(results, Results(finished())), "");
}

double RootMeanSquareDifference(const SvbrdfMaps& a, const SvbrdfMaps& b) {
  double sum = 0;
  for (size_t i = 0; i < a.planes.size(); ++i) sum += std::pow(a.planes[i] - b.planes[i], 2);
  return std::sqrt(sum / static_cast<double>(a.planes.size()));
}

// docs/conventions.md, "Same inputs, same bytes", states the tolerance.
TEST_F(DeterminismTest, OtherInstructionSetsGiveTheSameMapsWithinTheStatedTolerance) {
  fs::remove_all(capture() / "glint");
  const Outcome plain = RunProgram({Program("glint"), "run", capture().string()}, [] {
    ::setenv("GLINT_KERNEL", "baseline", 1);
    ::setenv("ATEN_CPU_CAPABILITY", "default", 1);
    ::setenv("DNNL_MAX_CPU_ISA", "SSE41", 1);
  });
  ASSERT_EQ(plain.code, 0) << plain.err;
  const Json facts = Json::parse(ReadAll(capture() / "glint/fit/run.json"));
  EXPECT_EQ(facts["instruction_sets"], Json({"baseline"}));
  for (const char* stage : {"fit", "refine"}) {
    const fs::path maps = fs::path("glint") / stage / "svbrdf.exr";
    EXPECT_LT(RootMeanSquareDifference(ReadSvbrdf(capture() / maps), ReadSvbrdf(finished() / maps)),
              0.01)
        << stage;
  }
}

TEST_F(DeterminismTest, EveryManifestKeepsTheSchema) {
  const std::string root = GLINT_SOURCE_DIR;
  const std::vector<std::string> check{"/usr/bin/python3",
                                       root + "/tests/base/formats/check_manifests.py",
                                       root + "/base/formats/manifest.schema.json"};
  const auto run = [&](const fs::path& what) {
    std::vector<std::string> words = check;
    words.push_back(what.string());
    return RunProgram(words);
  };
  const Outcome good = run(finished());
  EXPECT_EQ(good.code, 0) << good.out << good.err;
  const fs::path manifest = capture() / "glint" / "fit" / "manifest.json";
  Json json = Json::parse(ReadAll(manifest));
  json.erase("stage");
  WriteAll(manifest, json.dump());
  EXPECT_EQ(run(capture()).code, 1);
}

TEST_F(DeterminismTest, ASecondRunStartsNoStage) { EXPECT_THAT(RunJson().started, IsEmpty()); }

TEST_F(DeterminismTest, AChangedRefineOptionComputesRefineAndLaterStagesOnly) {
  EditToml("[refine]\niterations = 8", "[refine]\niterations = 9");
  EXPECT_THAT(RunJson().computed, ElementsAre("refine", "export", "report"));
  EXPECT_THAT(RunJson().started, IsEmpty());
}

TEST_F(DeterminismTest, ATouchedPhotographComputesNothing) {
  fs::last_write_time(Photos()[0], fs::file_time_type::clock::now());
  EXPECT_THAT(RunJson().computed, IsEmpty());
  EXPECT_THAT(RunJson().started, IsEmpty());
  EXPECT_EQ(Differences(Results(finished()), Results(capture())), "");
}

TEST_F(DeterminismTest, AChangedPhotographIsNoticed) {
  // A comment segment after the first two bytes: the picture is the same, the file is not.
  std::string bytes = ReadAll(Photos()[1]);
  bytes.insert(2, std::string("\xff\xfe\x00\x05"
                              "abc",
                              7));
  WriteAll(Photos()[1], bytes);
  EXPECT_THAT(RunJson({"--until", "rectify"}).computed, ElementsAre("calib", "rectify"));
}

TEST_F(DeterminismTest, KeepingAPhotographBackIsRecordedAndUndone) {
  const std::string photo = Photos()[3].filename();
  EXPECT_THAT(RunJson({"--exclude", photo}).computed,
              ElementsAre("fit", "refine", "export", "report"));
  const Json report = Json::parse(ReadAll(capture() / "glint/report/manifest.json"));
  EXPECT_EQ(report["metrics"]["held_out"]["photographs"], 1);
  RunJson();
  EXPECT_EQ(Differences(Results(finished()), Results(capture())), "");
}

TEST_F(DeterminismTest, ARunWithoutRefinementStopsAfterFit) {
  const std::string method = HasWeights() ? "latent" : "classic";
  EXPECT_EQ(RunCapture({"--method", method}).code, 0);
  const Json manifest = Json::parse(ReadAll(capture() / "glint/export/manifest.json"));
  EXPECT_EQ(manifest["options"]["from"], "fit");
}

TEST_F(DeterminismTest, StatusSaysThatAllIsUpToDate) {
  const Outcome outcome = Glint({"status", capture().string(), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json status = Json::parse(outcome.out);
  ASSERT_EQ(status["stages"].size(), 6u);
  for (const Json& stage : status["stages"]) EXPECT_EQ(stage["state"], "up to date") << stage;
}

}  // namespace
}  // namespace glint::test
