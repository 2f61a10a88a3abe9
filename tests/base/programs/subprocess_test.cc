#include "base/programs/subprocess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "base/errors/errors.h"
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

// kill -9 of a stage leaves nothing behind that goes on writing.
TEST(RunToLog, AChildDiesWithItsKilledParent) {
  const test::TemporaryFolder folder;
  const auto alive = folder.path() / "alive";
  const pid_t parent = ::fork();
  if (parent == 0) {
    RunToLog({"/bin/sh", "-c", "while :; do date +%s%N > " + alive.string() + "; sleep 0.05; done"},
             folder.path() / "log");
    ::_exit(0);
  }
  const auto wait = [](int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); };
  for (int i = 0; i < 200 && !std::filesystem::exists(alive); ++i) wait(50);
  ASSERT_TRUE(std::filesystem::exists(alive));
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  wait(300);
  const std::string last = test::ReadAll(alive);
  wait(500);
  EXPECT_EQ(test::ReadAll(alive), last);
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

TEST(RunInGroup, TellsHowTheProgramEnded) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(RunInGroup({"/bin/sh", "-c", "exit 7"}, folder.path() / "log", {}), 7);
  EXPECT_EQ(RunInGroup({"/bin/sh", "-c", "kill -TERM $$"}, folder.path() / "log", {}),
            128 + SIGTERM);
}

// As Ctrl-C does: what the program has started ends too, though its parent waits for signals
// itself.
TEST(RunInGroup, ACancelledProgramIsInterruptedWithItsChildren) {
  const test::TemporaryFolder folder;
  sigset_t signals, before;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, &before);
  RunInGroupOptions options;
  options.cancelled = [&] { return std::filesystem::exists(folder.path() / "begun"); };
  const auto begin = std::chrono::steady_clock::now();
  const int code = RunInGroup(
      {"/bin/sh", "-c", "sleep 30 & touch " + (folder.path() / "begun").string() + "; sleep 30"},
      folder.path() / "log", options);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  EXPECT_EQ(code, 128 + SIGINT);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

}  // namespace
}  // namespace glint
