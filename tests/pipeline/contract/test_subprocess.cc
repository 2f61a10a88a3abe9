#include "pipeline/contract/subprocess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/contract/errors.h"
#include "tests/support/process.h"

namespace glint {
namespace {

TEST(RunToLog, KeepsWhatTheProgramSays) {
  const test::TemporaryFolder folder;
  const auto log = folder.path() / "log";
  RunToLog({"/bin/sh", "-c", "echo out; echo err >&2"}, log);
  RunToLog({"/bin/sh", "-c", "echo \"$0\"", "a b  'c'"}, log);
  EXPECT_EQ(test::ReadAll(log), "out\nerr\na b  'c'\n");
}

TEST(RunToLog, FailureNamesCodeAndLastWords) {
  const test::TemporaryFolder folder;
  try {
    RunToLog({"/bin/sh", "-c", "echo no such sample; exit 7"}, folder.path() / "log");
    FAIL() << "did not throw";
  } catch (const ComputationError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("exit code 7"));
    EXPECT_THAT(error.what(), testing::HasSubstr("no such sample"));
  }
}

TEST(RunToLog, AProgramThatIsNotThereIsTheEnvironmentsFault) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(RunToLog({"/nonexistent/program"}, folder.path() / "log"), EnvironmentError);
  EXPECT_THROW(SiblingProgram("glint-nothing"), EnvironmentError);
}

TEST(RunToLog, AddsVariablesAndCallsWhileItRuns) {
  const test::TemporaryFolder folder;
  int calls = 0;
  ::setenv("GLINT_TEST_VARIABLE", "outer", 1);
  RunToLog({"/bin/sh", "-c", "sleep 0.3; echo $GLINT_TEST_VARIABLE"}, folder.path() / "log",
           {{"GLINT_TEST_VARIABLE=inner"}, [&] { ++calls; }});
  EXPECT_EQ(test::ReadAll(folder.path() / "log"), "inner\n");
  EXPECT_GE(calls, 2);
}

TEST(ProgramOnPath, FindsOrSaysHowToInstall) {
  EXPECT_EQ(ProgramOnPath("sh", "").filename(), "sh");
  try {
    ProgramOnPath("no-such-program", "apt-get install it");
    FAIL() << "did not throw";
  } catch (const EnvironmentError& error) {
    EXPECT_STREQ(error.what(),
                 "no-such-program: no such program; install it with: apt-get install it");
  }
}

}  // namespace
}  // namespace glint
