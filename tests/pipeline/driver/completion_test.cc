// Completion scripts and manual pages say what the programs have, in their shells' languages.
#include <gmock/gmock.h>

#include <algorithm>

#include "base/programs/cost_model.h"
#include "base/programs/run_progress.h"
#include "pipeline/driver/completion.h"
#include "pipeline/driver/edge.h"
#include "pipeline/driver/manual.h"
#include "pipeline/driver/stage_graph.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

// One program with options, one with verbs; texts with what shells and roff read as their own.
std::vector<DescribedCommand> Commands() {
  const Json method = {{"name", "method"},
                       {"help", "how: 'latent', [classic] or `other`; $HOME \\ stays"},
                       {"kind", "text"},
                       {"positional", false},
                       {"choices", {"latent", "classic"}},
                       {"default", "latent"}};
  const Json start = {
      {"name", "start"}, {"help", ".hidden\n.file"}, {"kind", "path"}, {"positional", false}};
  return {{{"fit"}, "Fits maps. It's one.", "Example: glint fit wood", Json{method, start}},
          {{"synth"}, "Makes things.", "", nullptr},
          {{"synth", "capture"}, "Renders photographs.", "", Json{start}}};
}

TEST(Completion, BashCompletesVerbsOptionsAndChoices) {
  const test::TemporaryFolder folder;
  const auto script = folder.Write("glint.bash", CompletionScript("bash", Commands()));
  const auto complete = [&](const std::string& words, int at) {
    const test::Outcome outcome = test::RunProgram(
        {"/bin/bash", "-c",
         "set -u; source '" + script.string() + "'; COMP_WORDS=(" + words +
             "); COMP_CWORD=" + std::to_string(at) + "; _glint; echo \"${COMPREPLY[*]}\""});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.out;
  };
  EXPECT_EQ(complete("glint ''", 1), "fit synth\n");
  EXPECT_EQ(complete("glint synth ''", 2), "capture\n");
  EXPECT_EQ(complete("glint fit --met", 2), "--method\n");
  EXPECT_EQ(complete("glint fit --method ''", 3), "latent classic\n");
  EXPECT_EQ(complete("glint synth capture --st", 3), "--start --status\n");
}

TEST(Completion, ScriptsOfOtherShellsNameEveryVerbAndOption) {
  for (const std::string shell : {"zsh", "fish"}) {
    const std::string script = CompletionScript(shell, Commands());
    for (const char* word : {"fit", "synth", "capture", "method", "latent classic", "start"}) {
      EXPECT_THAT(script, HasSubstr(word)) << shell;
    }
  }
  EXPECT_ANY_THROW(CompletionScript("tcsh", Commands()));
}

TEST(Manual, LinesOfTextAreNeverReadAsRequests) {
  const auto commands = Commands();
  const std::string page = ManualPage(commands[0], {}, "1.2");
  EXPECT_THAT(page, HasSubstr("\n\\&.hidden\n\\&.file\n"));
  EXPECT_THAT(page, HasSubstr("$HOME \\e stays"));
  EXPECT_THAT(page, HasSubstr("(default: latent)"));
  EXPECT_THAT(page, HasSubstr("\\fB\\-\\-method\\fR latent|classic"));
}

TEST(Manual, EveryVerbHasAPage) {
  const test::TemporaryFolder folder;
  const auto files = WriteManual(folder / "man", Commands(), "1.2");
  ASSERT_EQ(files.size(), 3u);
  EXPECT_THAT(test::ReadAll(folder / "man/glint-synth.1"), HasSubstr("SYNTH CAPTURE"));
  EXPECT_THAT(test::ReadAll(folder / "man/glint.1"), HasSubstr("glint\\-fit"));
}

TEST(Completion, TheBuiltProgramsDescribeThemselves) {
  const test::Outcome outcome =
      test::RunProgram({std::string(GLINT_BIN_DIR) + "/glint-run", "--describe"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json described = Json::parse(outcome.out);
  std::vector<std::string> names;
  for (const Json& option : described["options"]) names.push_back(option["name"]);
  EXPECT_THAT(names, Contains("exclude"));
  EXPECT_THAT(names, Contains("jobs"));
}

TEST(RunProgress, SharesOfStagesAddUpAndTimeIsCountedByWhatIsDone) {
  const std::string plan = ToText(RunPlan{1000, {{"calib", 10}, {"fit", 20}, {"refine", 10}}});
  const auto fit = ParseRunProgress(ProgressOf(plan, "fit"));
  ASSERT_TRUE(fit);
  EXPECT_DOUBLE_EQ(fit->Share(0), 0.25);
  EXPECT_DOUBLE_EQ(fit->Share(1), 0.75);
  // Half is done after 40 s instead of 20: another 40.
  EXPECT_NEAR(*fit->Remaining_s(0.5, 1040), 40, 1e-9);
  const auto calib = ParseRunProgress(ProgressOf(plan, "calib"));
  EXPECT_FALSE(calib->Remaining_s(0.01, 1001));
  EXPECT_EQ(ProgressOf(plan, "report"), "");
  EXPECT_EQ(ProgressOf("nonsense", "fit"), "");
  EXPECT_FALSE(ParseRunProgress("1 2 x"));
}

TEST(RunProgress, DurationsAreSaidAsPeopleDo) {
  EXPECT_EQ(DurationText(0.4), "0 s");
  EXPECT_EQ(DurationText(89), "89 s");
  EXPECT_EQ(DurationText(91), "2 min");
  EXPECT_EQ(DurationText(4200), "1 h 10 min");
}

TEST(CostModel, EveryStageCostsMoreOfALargerCapture) {
  for (const std::string& stage : StageNames()) {
    const double small = PredictedSeconds(stage, {5, 12e6, 256.0 * 256});
    EXPECT_GT(small, 0) << stage;
    EXPECT_GT(PredictedSeconds(stage, {12, 12e6, 1024.0 * 1024}), small) << stage;
  }
  EXPECT_EQ(PredictedSeconds("other", {5, 12e6, 256.0 * 256}), 0);
}

}  // namespace
}  // namespace glint
