#include "datasets/evaluation/subprocess.h"

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

}  // namespace
}  // namespace glint
