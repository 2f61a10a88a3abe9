// glint-synth and glint-eval as a person uses them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files/json.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using testing::HasSubstr;

const fs::path kBin = GLINT_BIN_DIR;

Outcome Synth(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), (kBin / "glint-synth").string());
  return test::RunProgram(arguments);
}

Outcome Eval(std::vector<std::string> arguments, const fs::path& bin = kBin) {
  arguments.insert(arguments.begin(), (bin / "glint-eval").string());
  return test::RunProgram(arguments);
}

class ProgramsTest : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  test::TemporaryFolder folder_;
};

TEST_F(ProgramsTest, AnUnknownInstructionSetIsRefused) {
  ::setenv("GLINT_KERNEL", "xyz", 1);
  const Outcome outcome = Synth({"views", "procedural:1", Path("views"), "--count", "1"});
  ::unsetenv("GLINT_KERNEL");
  EXPECT_NE(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("GLINT_KERNEL: found 'xyz'"));
}

TEST_F(ProgramsTest, MaterialIsWrittenListedAndCompared) {
  const Outcome list = Synth({"material", "--list"});
  EXPECT_EQ(list.code, 0);
  EXPECT_THAT(list.out, HasSubstr("leather\n"));
  EXPECT_GE(std::count(list.out.begin(), list.out.end(), '\n'), 12);
  EXPECT_EQ(
      Synth({"material", "--family", "wood", "--seed", "3", "--size", "64", "--png", Path("wood")})
          .code,
      0);
  EXPECT_TRUE(fs::exists(Path("wood/svbrdf.png")));
  const Outcome same = Eval({"maps", Path("wood"), "procedural:wood:3", "--json"});
  ASSERT_EQ(same.code, 0) << same.err;
  EXPECT_EQ(Json::parse(same.out)["render"], 0.0);
  const Outcome other = Eval({"maps", Path("wood"), "procedural:wood:4", "--json"});
  EXPECT_GT(Json::parse(other.out)["map_average"].get<double>(), 1e-4);
}

// A small version of the 20 captures of docs/real-captures.md.
TEST_F(ProgramsTest, LightOfAPhoneCaptureIsFoundAndKept) {
  const std::vector<std::string> arguments = {
      "light", "--work",       Path("light"), "--seeds",      "1",  "--photos",
      "8",     "--megapixels", "2",           "--resolution", "32", "--json"};
  const Outcome light = Eval(arguments);
  ASSERT_EQ(light.code, 0) << light.err;
  const Json summary = Json::parse(light.out)["summary"];
  EXPECT_LT(summary["flash"]["largest"].get<double>(), 2.5);
  EXPECT_LT(summary["vignetting"]["largest"].get<double>(), 1.5);
  EXPECT_LT(summary["exposure"]["largest"].get<double>(), 1.0);
  EXPECT_LT(summary["ambient"]["largest"].get<double>(), 35);
  EXPECT_GT(summary["within_3_sigma_percent"].get<double>(), 85);
  fs::remove_all(Path("light/seed_000/capture"));
  const Outcome again = Eval(arguments);
  EXPECT_EQ(again.out, light.out) << again.err;
}

TEST_F(ProgramsTest, TruthOfACaptureHasNoError) {
  const Outcome capture = Synth({"capture", Path("c"), "--photos", "2", "--megapixels", "0.1",
                                 "--texels", "32", "--seed", "5", "--json"});
  ASSERT_EQ(capture.code, 0) << capture.err;
  EXPECT_EQ(Json::parse(capture.out)["photos"], 2);
  const Outcome cameras =
      Eval({"cameras", Path("c/truth"), Path("c/truth/calib/manifest.json"), "--json"});
  ASSERT_EQ(cameras.code, 0) << cameras.err;
  EXPECT_LT(Json::parse(cameras.out)["corner_rms_texel"].get<double>(), 1e-6);
}

TEST_F(ProgramsTest, ViewsReRenderToTheirQuantisation) {
  ASSERT_EQ(Synth({"views", "procedural:9", Path("v"), "--count", "3", "--resolution", "32"}).code,
            0);
  const Outcome views = Eval({"views", Path("v/truth/svbrdf.exr"), Path("v/glint/rectify"),
                              "--exclude", "view_001", "--pairs", Path("pairs"), "--json"});
  ASSERT_EQ(views.code, 0) << views.err;
  const Json json = Json::parse(views.out);
  EXPECT_EQ(json["views"].size(), 2u);
  EXPECT_LT(json["mean"]["rmse"].get<double>(), 0.003);
  EXPECT_GT(json["mean"]["rmse"].get<double>(), 0);
  EXPECT_LT(json["mean"]["free"].get<double>(), 0.01);
  EXPECT_EQ(json["views"][0]["contrast"].size(), 4u);
  EXPECT_NEAR(json["views"][0]["correlation"][1].get<double>(), 1, 0.01);
  EXPECT_GT(json["mean"]["ssim"].get<double>(), 0.99);
  EXPECT_NEAR(json["mean"]["highlight"].get<double>(), 1, 0.01);
  EXPECT_TRUE(fs::exists(Path("pairs/view_002.png")));
  EXPECT_FALSE(fs::exists(Path("pairs/view_001.png")));
}

TEST_F(ProgramsTest, WrongUsageEndsWithTwoAndSaysWhy) {
  const auto expect = [](const Outcome& outcome, const std::string& word) {
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(word));
  };
  expect(Synth({}), "a verb is needed");
  expect(Synth({"paint"}), "'paint'");
  expect(Synth({"material"}), "out");
  expect(Synth({"material", "--family", "cheese", Path("m")}), "cheese");
  expect(Synth({"views", "procedural:x", Path("v")}), "procedural:SEED");
  expect(Synth({"views", Path("none.exr"), Path("v")}), "none.exr");
  expect(Synth({"capture", Path("c"), "--distance-mm", "3,2"}), "distance-mm");
  expect(Synth({"capture", Path("c"), "--flash-offset-mm", "1,2"}), "flash-offset-mm");
  expect(Eval({"maps", Path("a.exr"), Path("b.exr")}), "a.exr");
  expect(Eval({"cameras", Path("t"), Path("m")}), "truth.json");
  expect(Eval({"table1"}), "work");
  expect(Eval({"count", "--counts", "1.5", "--work", Path("w")}), "whole numbers");
  expect(Eval({"table1", "--methods", "luck", "--work", Path("w")}), "luck");
  expect(Eval({"count", "--status", "--work", Path("w")}), "status");
  expect(Eval({"ablation", "--work", Path("w")}), "NAME=FILE");
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(ProgramsTest, HelpAndVersionEndWithZero) {
  for (const std::string option : {"--help", "--version"}) {
    EXPECT_EQ(Synth({option}).code, 0);
    EXPECT_EQ(Eval({option}).code, 0);
    EXPECT_EQ(Eval({"views", option}).code, 0);
  }
}

// Experiments' bookkeeping, with programs that copy the truth in place of fitting, and say how they
// were called.
class ExperimentTest : public ProgramsTest {
 protected:
  ExperimentTest() : bin_(folder_.path() / "bin") {
    fs::create_directories(bin_);
    fs::copy_file(kBin / "glint-eval", bin_ / "glint-eval");
    for (const std::string stage : {"fit", "refine"}) {
      const fs::path program = bin_ / ("glint-" + stage);
      test::WriteAll(program,
                     "#!/bin/sh\necho \"$0 $*\" >> " + Path("calls") + "\nmkdir -p $1/glint/" +
                         stage + "\ncp $1/truth/svbrdf.exr $1/glint/" + stage +
                         "/\necho '{\"glint_manifest\":1,\"stage\":\"" + stage +
                         "\",\"stage_version\":1,\"inputs\":[],\"options\":{},\"outputs\":[],"
                         "\"data\":{},\"metrics\":{}}' > $1/glint/" +
                         stage + "/manifest.json\n");
      fs::permissions(program, fs::perms::owner_all);
    }
  }
  std::string Calls() const { return test::ReadAll(Path("calls")); }

  fs::path bin_;
};

TEST_F(ExperimentTest, Table1RunsTheProgramsBesideItAndKeepsResults) {
  const std::vector<std::string> arguments = {"table1",     "procedural:1000000001",
                                              "--counts",   "1,3",
                                              "--size",     "16",
                                              "--work",     Path("work"),
                                              "--fit-args", "--levels=2"};
  const Outcome first = Eval(arguments, bin_);
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("|  3 | refined | 0.000000 |"));
  const std::string calls = Calls();
  EXPECT_THAT(calls, HasSubstr("n03/classic --method classic"));
  EXPECT_THAT(calls, HasSubstr("glint-refine " + Path("work/procedural_1000000001/n01/latent")));
  EXPECT_THAT(calls, HasSubstr("--levels=2"));
  EXPECT_THAT(test::ReadAll(Path("work/table1.csv")), HasSubstr("mean,3,latent,0,0,0,0,0,0"));

  const Outcome again = Eval(arguments, bin_);
  EXPECT_EQ(again.out, first.out);
  EXPECT_EQ(Calls(), calls);  // nothing ran
}

TEST_F(ExperimentTest, ADeletedResultIsTheOnlyOneComputedAgain) {
  const std::vector<std::string> arguments = {
      "count", "procedural:1..2", "--counts", "1,2", "--size", "16", "--work", Path("work")};
  const Outcome first = Eval(arguments, bin_);
  ASSERT_EQ(first.code, 0) << first.err;
  const std::string before = Calls();
  ASSERT_TRUE(fs::remove(Path("work/procedural_2/n01/classic.json")));
  const Outcome again = Eval(arguments, bin_);
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(again.out, first.out);
  const std::string more = Calls().substr(before.size());
  EXPECT_EQ(std::count(more.begin(), more.end(), '\n'), 1);
  EXPECT_THAT(more, HasSubstr("procedural_2/n01/classic --method classic"));
}

TEST_F(ExperimentTest, EveryVerbWritesTableFiguresPlotAndPictures) {
  test::WriteAll(Path("w.safetensors"), "weights");
  const std::vector<std::vector<std::string>> verbs = {
      {"table1", "--disturb", "--counts", "1", "--methods", "classic,refined"},
      {"table2", "--counts", "2"},
      {"exposure", "--stops=-6,0", "--counts", "2"},
      {"hdr", "--counts", "2"},
      {"start", "--counts", "1", "--starts", "heuristic,rough"},
      {"topview", "--counts", "2", "--tilts", "30"},
      {"count", "--counts", "1,2"},
      {"ablation", "--counts", "1", "--weights", "all=" + Path("w.safetensors")}};
  for (std::vector<std::string> arguments : verbs) {
    const std::string verb = arguments.front();
    arguments.insert(arguments.begin() + 1, "procedural:1000000001");
    arguments.insert(arguments.end(), {"--size", "16", "--threads", "1", "--work", Path("work")});
    const Outcome outcome = Eval(arguments, bin_);
    ASSERT_EQ(outcome.code, 0) << verb << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("| 0.000000 |")) << verb;
    EXPECT_THAT(test::ReadAll(Path("work/" + verb + ".csv")), HasSubstr("mean,")) << verb;
    EXPECT_TRUE(Json::parse(test::ReadAll(Path("work/" + verb + ".json"))).contains("means"));
    EXPECT_THAT(test::ReadAll(Path("work/" + verb + ".svg")), HasSubstr("</svg>")) << verb;
    EXPECT_GT(fs::file_size(Path("work/" + verb + ".png")), 1000u) << verb;
  }
  const std::string calls = Calls();
  EXPECT_THAT(calls, HasSubstr("all-latent --method latent"));
  EXPECT_THAT(calls, HasSubstr("--start " + Path("work/procedural_1000000001/n01/rough-latent")));
  EXPECT_THAT(calls, HasSubstr("--initial-maps rules"));
}

// With the programs themselves: small, but whole.
TEST_F(ProgramsTest, ATinyTableEndToEnd) {
  const Outcome outcome =
      Eval({"table1", "procedural:1000000101", "--counts", "2", "--methods",
            "initial,classic,latent,refined", "--size", "32", "--threads", "1",
            "--fit-args=--initial-maps,rules,--iterations,5", "--work", Path("work"), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json means = Json::parse(outcome.out)["means"];
  ASSERT_EQ(means.size(), 4u);
  for (const Json& mean : means) {
    EXPECT_GT(mean["errors"]["map_average"].get<double>(), 0) << mean;
    EXPECT_LT(mean["errors"]["map_average"].get<double>(), 0.3) << mean;
  }
}

}  // namespace
}  // namespace glint
