// A full disk, a read-only folder, two runs at once, missing programs.
#include <gmock/gmock.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <sched.h>
#include <chrono>
#include <csignal>
#include <thread>

#include "tests/e2e/capture_fixture.h"

namespace glint::test {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;

class EnvironmentTest : public CaptureTest {
 protected:
  Outcome RunWith(const std::function<void()>& before_exec, std::vector<std::string> words = {}) {
    words.insert(words.begin(), {Program("glint"), "run", capture().string()});
    return RunProgram(words, before_exec);
  }
};

// Nothing may grow beyond `bytes`, which every write past it says as a full disk does.
void LimitFileSize(rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, SIG_IGN);
}

TEST_F(EnvironmentTest, AFullDiskKeepsEarlierResults) {
  EditToml("resolution_px = 64", "resolution_px = 256");
  const Outcome outcome = RunWith([] { LimitFileSize(60 << 10); });
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("space"));
  EXPECT_THAT(outcome.err, HasSubstr("residuals_camera0.png"));
  EXPECT_EQ(Differences(Results(finished()), Results(capture())), "");
  EditToml("resolution_px = 256", "resolution_px = 64");
  EXPECT_EQ(RunCapture().code, 0);
  EXPECT_EQ(Differences(Results(finished()), Results(capture())), "");
}

TEST_F(EnvironmentTest, AFullDiskFromTheStartIsNamed) {
  // Room for the message in the test's own file, not for build.ninja.
  const Outcome outcome = RunWith([] { LimitFileSize(500); }, {"--force"});
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("glint/build.ninja"));
  EXPECT_THAT(outcome.err, HasSubstr("free some space"));
  EXPECT_EQ(Differences(Results(finished()), Results(capture())), "");
}

// Root may write everywhere, so the folder is mounted read-only, in a mount namespace of the run's.
TEST_F(EnvironmentTest, AReadOnlyFolderIsNamed) {
  const std::string path = capture();
  const auto make_read_only = [path] {
    const bool done =
        ::unshare(CLONE_NEWNS) == 0 &&
        ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
        ::mount(path.c_str(), path.c_str(), nullptr, MS_BIND, nullptr) == 0 &&
        ::mount(nullptr, path.c_str(), nullptr, MS_REMOUNT | MS_BIND | MS_RDONLY, nullptr) == 0;
    if (!done) ::_exit(77);
  };
  EditToml("resolution_px = 64", "resolution_px = 32");
  const Outcome outcome = RunWith(make_read_only);
  if (outcome.code == 77) GTEST_SKIP() << "no right to mount a folder read-only here";
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(path + "/glint"));
  EXPECT_THAT(outcome.err, HasSubstr("make the folder writable"));
  EXPECT_EQ(Differences(Results(finished()), Results(capture())), "");
  const Outcome status = RunProgram({Program("glint"), "status", path}, make_read_only);
  EXPECT_EQ(status.code, 0) << status.err;
}

TEST_F(EnvironmentTest, TwoRunsAtOnceAreRefused) {
  fs::remove_all(capture() / "glint");
  const pid_t pid =
      Start({Program("glint"), "run", capture().string()}, folder() / "out", folder() / "err");
  while (!fs::exists(capture() / "glint/build.ninja")) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ::kill(-pid, SIGSTOP);
  const Outcome outcome = RunCapture();
  ::kill(-pid, SIGCONT);
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("found a lock held by another process (another glint run"));
  EXPECT_EQ(WaitFor(pid), 0) << ReadAll(folder() / "err");
  EXPECT_EQ(Differences(Results(finished()), Results(capture())), "");
}

}  // namespace
}  // namespace glint::test
