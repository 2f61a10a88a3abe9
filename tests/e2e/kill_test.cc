// Killed at any moment, the next run finishes without help, with the same bytes.
#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "tests/e2e/capture_fixture.h"

namespace glint::test {
namespace {

namespace fs = std::filesystem;

constexpr int kKills = 20;

class KillTest : public CaptureTest {};

TEST_F(KillTest, TwentyKillsLeaveWhatAnUninterruptedRunLeaves) {
  const Tree sources = Sources(finished());
  std::mt19937 random(1);
  // Short enough that twenty of them go through all stages and back, long enough to get somewhere.
  std::uniform_real_distribution<double> moment_s(0, 0.35 * run_seconds());
  fs::remove_all(capture() / "glint");
  int killed = 0, finished_first = 0;
  while (killed < kKills) {
    const pid_t pid =
        Start({Program("glint"), "run", capture().string()}, folder() / "out", folder() / "err");
    std::this_thread::sleep_for(std::chrono::duration<double>(moment_s(random)));
    // By turns the run alone, whose children have to end with it, and the whole group.
    ::kill(killed % 2 == 0 ? pid : -pid, SIGKILL);
    const int code = WaitFor(pid);
    ASSERT_TRUE(code == 0 || code == 128 + SIGKILL) << code << ReadAll(folder() / "err");
    if (code == 0) {
      ASSERT_LT(++finished_first, 40);
      EXPECT_EQ(Differences(Results(finished()), Results(capture())), "");
      fs::remove_all(capture() / "glint");
      continue;
    }
    ++killed;
  }
  const Outcome outcome = RunCapture();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Differences(Results(finished()), Results(capture())), "");
  EXPECT_EQ(Differences(sources, Sources(capture())), "");
  for (const auto& entry : fs::directory_iterator(capture() / "glint")) {
    const std::string name = entry.path().filename();
    EXPECT_EQ(name.find(".new"), std::string::npos) << name << " is left over";
  }
}

}  // namespace
}  // namespace glint::test
