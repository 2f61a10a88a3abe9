// Photographs that come in over HTTP.
#include <gtest/gtest.h>

#include "tests/studio/studio_fixture.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::JpegBytes;
using test::PngBytes;
using test::RunningStudio;

std::string PhotographsOf(const std::string& id) { return "/api/captures/" + id + "/photographs"; }

TEST(Upload, GoodAndBadFilesInOneRequestAreToldApart) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  const Json list = running.page
                        ->Upload(PhotographsOf(id), {{"a.jpg", JpegBytes(1)},
                                                     {"text.jpg", "not a picture at all, no, no"},
                                                     {"empty.jpg", ""},
                                                     {"../../b.jpg", JpegBytes(2)}})
                        .json()["photographs"];
  ASSERT_EQ(list.size(), 4u);
  EXPECT_TRUE(list[0]["error"].is_null());
  EXPECT_FALSE(list[1]["error"].is_null());
  EXPECT_FALSE(list[2]["error"].is_null());
  EXPECT_TRUE(list[3]["error"].is_null());
  EXPECT_EQ(test::ReadAll(running.folder / "wood/photos/a.jpg"), JpegBytes(1));
  EXPECT_EQ(test::ReadAll(running.folder / "wood/photos/b.jpg"), JpegBytes(2));
  EXPECT_FALSE(fs::exists(running.folder / "b.jpg"));
}

TEST(Upload, TheSamePhotographTwiceIsOneUnderItsFirstName) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  const auto send = [&](const std::string& name) {
    return running.page->Upload(PhotographsOf(id), {{name, JpegBytes(1)}})
        .json()["photographs"][0]["id"];
  };
  const Json first = send("a.jpg");
  EXPECT_EQ(send("a.jpg"), first);
  EXPECT_EQ(send("other.jpg"), first);
  EXPECT_EQ(running.Capture(id)["photographs"].size(), 1u);
}

TEST(Upload, ManyAtOnceFromManyConnectionsAllArrive) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  std::vector<std::thread> threads;
  for (int t = 0; t < 6; ++t) {
    threads.emplace_back([&, t] {
      test::Headers photographs;
      for (int i = 0; i < 10; ++i) photographs.emplace_back("image.jpg", JpegBytes(10 * t + i));
      running.page->Upload(PhotographsOf(id), photographs);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(running.Capture(id)["photographs"].size(), 60u);
}

TEST(Upload, APhotographTooLargeIsRefusedWhileItComes) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  const std::string large = JpegBytes(1) + std::string(201u << 20, '\0');
  const test::Answer answer = running.page->Upload(PhotographsOf(id), {{"a.jpg", large}});
  EXPECT_EQ(answer.status, 413);
  EXPECT_EQ(running.Capture(id)["photographs"].size(), 0u);
}

TEST(Upload, APhotographOfAnotherKindIsListedInCaptureToml) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  running.page->Upload(PhotographsOf(id), {{"a.jpeg", PngBytes(1)}});
  EXPECT_TRUE(fs::exists(running.folder / "wood/photos/a.png"));
  EXPECT_EQ(running.Capture(id)["photographs"].size(), 1u);
  EXPECT_NE(test::ReadAll(running.folder / "wood/capture.toml").find("\"photos/*.png\""),
            std::string::npos);
}

TEST(Upload, OneThatAKilledStudioHadKeptButNotListedIsListedWhenItIsSentAgain) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  const std::string bytes = PngBytes(1);
  running.folder.Write("wood/photos/a.png", bytes);
  EXPECT_EQ(running.Capture(id)["photographs"].size(), 0u);
  const Json sent = running.page->Upload(PhotographsOf(id), {{"a.png", bytes}}).json();
  EXPECT_TRUE(sent["photographs"][0]["error"].is_null());
  const Json photographs = running.Capture(id)["photographs"];
  ASSERT_EQ(photographs.size(), 1u);
  EXPECT_EQ(photographs[0]["id"], sent["photographs"][0]["id"]);
  EXPECT_FALSE(fs::exists(running.folder / "wood/photos/a-2.png"));
}

TEST(Upload, ABadPhotographIsKeptButLeftOutUntilAPersonDecides) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  running.page->Upload(PhotographsOf(id), {{"a.jpg", JpegBytes(1)}});
  Json photo = running.CheckedCapture(id)["photographs"][0];
  EXPECT_EQ(photo["state"], "bad");
  EXPECT_TRUE(photo["left_out"].get<bool>());
  EXPECT_FALSE(photo["reason"].is_null());
  EXPECT_FALSE(photo["remedy"].is_null());
  EXPECT_FALSE(photo["thumbnail"].is_null());
  EXPECT_EQ(running.page->Get(photo["thumbnail"]).body.substr(0, 2), "\xff\xd8");
  const std::string path = PhotographsOf(id) + "/" + photo["id"].get<std::string>();
  EXPECT_EQ(running.page->Send("PUT", path, {{"left_out", false}}).status, 200);
  running.page->Upload(PhotographsOf(id), {{"b.jpg", JpegBytes(2)}});
  for (const Json& one : running.CheckedCapture(id)["photographs"]) {
    EXPECT_EQ(one["left_out"].get<bool>(), one["name"] == "b.jpg");
  }
  EXPECT_TRUE(fs::exists(running.folder / "wood/photos/a.jpg"));
}

TEST(Upload, PhotographsThatWereThereBeforeStudioAreNotDecidedAbout) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  running.folder.Write("wood/photos/mine.jpg", JpegBytes(1));
  const std::string before = test::ReadAll(running.folder / "wood/capture.toml");
  EXPECT_EQ(running.CheckedCapture(id)["photographs"][0]["state"], "bad");
  EXPECT_EQ(test::ReadAll(running.folder / "wood/capture.toml"), before);
}

TEST(Upload, ACaptureOfOnePhotographIsDescribedWhenItIsThere) {
  const RunningStudio running;
  const Json made = running.page
                        ->Post("/api/captures", {{"name", "one"},
                                                 {"kind", "single"},
                                                 {"size_mm", nullptr},
                                                 {"picture_width_mm", 120}})
                        .json();
  const std::string id = made["id"];
  EXPECT_EQ(running.Capture(id)["status"], "empty");
  EXPECT_FALSE(fs::exists(running.folder / "one/capture.toml"));
  running.page->Upload(PhotographsOf(id), {{"a.jpg", JpegBytes(1)}});
  EXPECT_TRUE(fs::exists(running.folder / "one/capture.toml"));
  const Json capture = running.CheckedCapture(id);
  EXPECT_EQ(capture["kind"], "single");
  EXPECT_EQ(capture["status"], "ready");
  const Json second =
      running.page->Upload(PhotographsOf(id), {{"b.jpg", JpegBytes(2)}}).json()["photographs"][0];
  EXPECT_FALSE(second["error"].is_null());
  EXPECT_EQ(running.Capture(id)["photographs"].size(), 1u);
}

TEST(Upload, ACaptureWhoseOnePhotographArrivedBeforeAKillIsDescribedByTheNextStudio) {
  const test::TemporaryFolder kept;
  StudioOptions options;
  options.folder = kept.path();
  options.port = 0;
  {
    const Studio studio(options);
    const test::PageClient page(studio.address());
    page.Post("/api/captures", {{"name", "one"}, {"kind", "single"}, {"picture_width_mm", 120}});
  }
  kept.Write("one/photos/a.jpg", JpegBytes(1));
  kept.Write("one/capture.toml.tmp123", "[sam");
  kept.Write("one/capture.toml.tmp.mine", "[sample]");
  const Studio studio(options);
  EXPECT_TRUE(fs::exists(kept / "one/capture.toml"));
  EXPECT_FALSE(fs::exists(kept / "one/capture.toml.tmp123"));
  EXPECT_TRUE(fs::exists(kept / "one/capture.toml.tmp.mine"));
}

TEST(Upload, ChecksAreFoundAgainByContent) {
  test::TemporaryFolder kept;
  std::string state;
  for (int round = 0; round < 2; ++round) {
    StudioOptions options;
    options.folder = kept.path();
    options.port = 0;
    options.check_threads = 1;
    const Studio studio(options);
    const test::PageClient page(studio.address());
    if (round == 0) {
      const Json board = page.Post("/api/boards", {{"paper", "A4"}}).json();
      page.Post("/api/captures", {{"name", "wood"}, {"board", board["id"]}, {"size_mm", {50, 50}}});
    }
    const std::string id = page.Get("/api/library").json()["captures"][0]["id"];
    if (round == 0) page.Upload(PhotographsOf(id), {{"a.jpg", JpegBytes(1)}});
    for (int i = 0; i < 500 && (state.empty() || state == "waiting" || state == "checking"); ++i) {
      state = page.Get("/api/captures/" + id).json()["photographs"][0]["state"];
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_EQ(state, "bad");
    state.clear();
  }
  size_t checks = 0;
  for (const auto& file : fs::directory_iterator(kept / "wood/glint/.studio/checks")) {
    checks += file.path().extension() == ".json" ? 1 : 0;
  }
  EXPECT_EQ(checks, 1u);
}

}  // namespace
}  // namespace glint
