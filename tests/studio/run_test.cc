// From photographs over a run to files, as a browser asks for it, and the same capture from the
// command line.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "tests/studio/studio_fixture.h"
#include "tests/studio/synthetic.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::RunningStudio;

std::string RunState(const RunningStudio& running, const std::string& id) {
  const Json run = running.Capture(id)["run"];
  return run.is_null() ? "" : run["state"].get<std::string>();
}

std::string WaitForRun(const RunningStudio& running, const std::string& id) {
  std::string state = RunState(running, id);
  for (int i = 0; i < 600 && (state == "running" || state.empty()); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    state = RunState(running, id);
  }
  return state;
}

// The process whose command line begins so; 0: there is none.
pid_t ProcessOf(const std::string& program, const std::string& argument) {
  const std::string wanted = program + '\0' + argument + '\0';
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc", error)) {
    const pid_t pid = std::atoi(entry.path().filename().c_str());
    if (pid > 0 && test::ReadAll(entry.path() / "cmdline").starts_with(wanted)) return pid;
  }
  return 0;
}

void ExpectThatAKilledRunSaysWhatToDo(const RunningStudio& running, const std::string& id,
                                      const fs::path& capture) {
  ASSERT_EQ(running.page->Post("/api/captures/" + id + "/run", {{"quick", true}}).status, 200);
  pid_t pid = 0;
  for (int i = 0; i < 500 && pid == 0; ++i) {
    pid = ProcessOf(std::string(GLINT_BIN_DIR) + "/glint-run", capture.string());
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_GT(pid, 0);
  ::kill(pid, SIGKILL);
  EXPECT_EQ(WaitForRun(running, id), "failed");
  const Json run = running.Capture(id)["run"];
  EXPECT_NE(run["message"].get<std::string>().find("was killed"), std::string::npos) << run;
  EXPECT_NE(run["remedy"].get<std::string>().find("run it again"), std::string::npos) << run;
}

TEST(StudioRun, ThePhotographsBecomeAMaterialAndTheCommandLineGoesOnFromThere) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  test::MakeSynthetic(running.folder / ".shots", 4,
                      running.folder / ".glint-studio/boards/A4-100x100/board.json");
  test::Headers photographs;
  for (const auto& file : fs::directory_iterator(running.folder / ".shots/photos")) {
    photographs.emplace_back(file.path().filename(), test::ReadAll(file.path()));
  }
  const std::string path = "/api/captures/" + id;
  running.page->Upload(path + "/photographs", photographs);
  for (const Json& photo : running.CheckedCapture(id)["photographs"]) {
    EXPECT_NE(photo["state"], "bad") << photo;
    EXPECT_FALSE(photo["tilt_deg"].is_null());
  }
  ASSERT_EQ(
      running.page->Send("PUT", path + "/options", {{"sample", {{"resolution_px", 64}}}}).status,
      200);

  // A run that is cancelled.
  ASSERT_EQ(running.page->Post(path + "/run", {{"quick", true}}).status, 200);
  EXPECT_EQ(running.page->Post(path + "/run", {{"quick", true}}).status, 409);
  EXPECT_EQ(running.page->Post(path + "/cancel").status, 200);
  EXPECT_EQ(WaitForRun(running, id), "cancelled");
  ExpectThatAKilledRunSaysWhatToDo(running, id, running.folder / "wood");

  ASSERT_EQ(running.page->Post(path + "/run", {{"quick", true}}).status, 200);
  EXPECT_EQ(WaitForRun(running, id), "done") << running.Capture(id)["run"];
  const Json capture = running.Capture(id);
  EXPECT_EQ(capture["status"], "done");
  EXPECT_TRUE(capture["result"]["quick"].get<bool>());
  for (const Json& map : capture["result"]["maps"]) {
    EXPECT_EQ(running.page->Get(map["url"]).body.substr(1, 3), "PNG");
  }
  EXPECT_EQ(running.page->Get(capture["result"]["zip"]).body.substr(0, 2), "PK");
  EXPECT_EQ(running.page->Get(capture["result"]["glb"]).body.substr(0, 4), "glTF");
  EXPECT_GT(running.page->Get(capture["result"]["page"]).body.size(), 1000u);

  const test::TemporaryFolder scratch;
  const pid_t again = test::Start(
      {std::string(GLINT_BIN_DIR) + "/glint-run", (running.folder / "wood").string(), "--quick"},
      scratch / "out", scratch / "err");
  EXPECT_EQ(test::WaitFor(again), 0);
  EXPECT_NE(test::ReadAll(scratch / "out").find("up to date: calib, rectify, fit, export, report"),
            std::string::npos)
      << test::ReadAll(scratch / "out");
}

TEST(StudioRun, AFailureIsToldAsTheProgramTellsIt) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  running.folder.Write("wood/photos/a.jpg", test::JpegBytes(1));
  ASSERT_EQ(running.page->Post("/api/captures/" + id + "/run", {{"quick", true}}).status, 200);
  EXPECT_EQ(WaitForRun(running, id), "failed");
  const Json capture = running.Capture(id);
  EXPECT_EQ(capture["status"], "failed");
  EXPECT_NE(capture["run"]["message"].get<std::string>().find("found the board in none"),
            std::string::npos)
      << capture["run"];
  EXPECT_FALSE(capture["run"]["remedy"].is_null());
  EXPECT_EQ(running.page->Post("/api/captures/" + running.MakeCapture("empty") + "/run").status,
            422);
}

}  // namespace
}  // namespace glint
