// glint-studio as a process: it is killed, and started twice.
#include <gtest/gtest.h>

#include <csignal>
#include <random>

#include "tests/studio/http_client.h"
#include "tests/studio/picture.h"
#include "tests/studio/studio_process.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::JpegBytes;
using test::StudioProcess;

// A capture by hand, so that no board need be printed.
void WriteCaptureByHand(const test::TemporaryFolder& folder) {
  folder.Write("wood/capture.toml",
               "[sample]\nsize_mm = [90, 90]\nresolution_px = 64\n[photos]\nfiles = "
               "[\"photos/*.jpg\"]\n[board]\nkind = \"charuco\"\nsquares = [13, 17]\n"
               "square_mm = 15\nmarker_mm = 11\nwindow = [3, 5, 7, 7]\n");
  fs::create_directories(folder / "wood/photos");
}

std::string OnlyCapture(const test::PageClient& page) {
  return page.Get("/api/library").json()["captures"][0]["id"];
}

TEST(StudioProgram, ASecondOneOfTheFolderSaysSoAndEnds) {
  const test::TemporaryFolder folder, scratch, other;
  const StudioProcess first(folder.path(), scratch.path());
  ASSERT_FALSE(first.address.empty());
  const pid_t second = test::Start({std::string(GLINT_BIN_DIR) + "/glint-studio",
                                    folder.path().string(), "--no-browser", "--port", "0"},
                                   other / "out", other / "err");
  EXPECT_EQ(test::WaitFor(second), 2);
  EXPECT_NE(test::ReadAll(other / "err").find("another Glint Studio"), std::string::npos);
}

TEST(StudioProgram, CtrlCEndsItWell) {
  const test::TemporaryFolder folder, scratch;
  StudioProcess studio(folder.path(), scratch.path());
  ASSERT_FALSE(studio.address.empty());
  EXPECT_EQ(studio.End(SIGINT), 0);
}

TEST(StudioProgram, KilledAtAnyMomentOfUploadsItLeavesNothingTornAndLosesNothing) {
  const test::TemporaryFolder folder, scratch;
  WriteCaptureByHand(folder);
  const std::string toml = test::ReadAll(folder / "wood/capture.toml");
  std::mt19937 random(1);
  std::map<std::string, std::string> confirmed;  // name → bytes
  std::vector<std::string> pictures;
  for (int i = 0; i < 12; ++i) pictures.push_back(JpegBytes(i, 800, 600));
  for (int round = 0; round < 8; ++round) {
    StudioProcess studio(folder.path(), scratch.path());
    ASSERT_FALSE(studio.address.empty()) << test::ReadAll(studio.err);
    const test::PageClient page(studio.address);
    const std::string path = "/api/captures/" + OnlyCapture(page) + "/photographs";
    std::thread killer([&, wait_ms = 5 + static_cast<int>(random() % 400)] {
      std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
      ::kill(studio.pid, SIGKILL);
    });
    for (int i = 0; i < 12; ++i) {
      const std::string name = std::to_string(round) + "_" + std::to_string(i) + ".jpg";
      std::string bytes = pictures[static_cast<size_t>(i)];
      bytes.insert(bytes.size() - 2, 1, static_cast<char>(round));  // another photograph
      const Json answer = page.Upload(path, {{name, bytes}}).json();
      if (!answer.is_object()) break;  // killed
      ASSERT_TRUE(answer.contains("photographs")) << answer;
      ASSERT_TRUE(answer["photographs"][0]["error"].is_null()) << answer;
      confirmed[name] = bytes;
    }
    killer.join();
    studio.End(SIGKILL);
    for (const auto& file : fs::directory_iterator(folder / "wood/photos")) {
      if (file.path().filename().string()[0] == '.') continue;
      const std::string bytes = test::ReadAll(file.path());
      EXPECT_GT(bytes.size(), 1000u) << file.path();
      EXPECT_EQ(bytes.substr(bytes.size() - 2), "\xff\xd9") << file.path();
    }
    for (const auto& [name, bytes] : confirmed) {
      EXPECT_EQ(test::ReadAll(folder / "wood/photos" / name), bytes) << name;
    }
    const std::string now = test::ReadAll(folder / "wood/capture.toml");
    EXPECT_TRUE(now.starts_with(toml.substr(0, toml.find("[photos]")))) << now;
    EXPECT_NE(now.find("window = [3, 5, 7, 7]"), std::string::npos) << now;
  }
  EXPECT_FALSE(confirmed.empty());
  const StudioProcess last(folder.path(), scratch.path());
  for (const auto& file : fs::directory_iterator(folder / "wood/photos")) {
    EXPECT_FALSE(file.path().filename().string().starts_with(".upload-")) << file.path();
  }
}

}  // namespace
}  // namespace glint
