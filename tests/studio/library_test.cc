// The library: what it shows of captures that Studio has not made.
#include <gtest/gtest.h>

#include "tests/studio/studio_fixture.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::RunningStudio;

// As a capture of glint init and glint calib lies there.
void MakeByHand(const RunningStudio& running, const std::string& name) {
  fs::create_directories(running.folder / (name + "/photos"));
  fs::create_directories(running.folder / (name + "/glint/calib"));
  running.folder.Write(name + "/capture.toml",
                       "[sample]\nsize_mm = [100, 100]\nresolution_px = 256\n"
                       "[photos]\nfiles = [\"photos/*.jpg\"]\n"
                       "[board]\nkind = \"charuco\"\nsquares = [18, 14]\nsquare_mm = 13\n"
                       "marker_mm = 9.75\ndictionary = \"DICT_5X5_1000\"\nwindow = [5, 3, 8, 8]\n");
  running.folder.Write(name + "/photos/a.jpg", test::JpegBytes(1));
  running.folder.Write(name + "/glint/calib/manifest.json",
                       R"({"metrics": {"guidance": {"verdict": "not enough"}}})");
}

Json RowOf(const RunningStudio& running, const std::string& name) {
  const Json library = running.page->Get("/api/library").json();
  for (const Json& row : library["captures"]) {
    if (row["name"] == name) return row;
  }
  return nullptr;
}

TEST(Library, ACaptureOfTheCommandLineHasPictureAndVerdictBeforeItIsOpened) {
  const RunningStudio running;
  MakeByHand(running, "leather");
  Json row;
  for (int i = 0; i < 200 && (row.is_null() || row["thumbnail"].is_null()); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    row = RowOf(running, "leather");
  }
  EXPECT_EQ(row["verdict"], "poor");
  ASSERT_TRUE(row["thumbnail"].is_string()) << row;
  EXPECT_EQ(running.page->Get(row["thumbnail"]).body.substr(0, 2), "\xff\xd8");
}

TEST(Library, ABoardThatACaptureUsesCanBeChosenForAnother) {
  const RunningStudio running;
  MakeByHand(running, "leather");
  MakeByHand(running, "same-board");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // the list is a second old at most
  const Json boards = running.page->Get("/api/boards").json()["boards"];
  ASSERT_EQ(boards.size(), 1u) << boards;  // glint-synth's own, which Studio knows anyway
  EXPECT_EQ(boards[0]["name"], "leather");
  EXPECT_FALSE(boards[0]["pdf"].get<bool>());
  const Json made = running.page
                        ->Post("/api/captures", {{"name", "wood"},
                                                 {"kind", "board"},
                                                 {"size_mm", {80, 80}},
                                                 {"board", boards[0]["id"]}})
                        .json();
  const Json capture = running.Capture(made.value("id", ""));
  EXPECT_EQ(capture["kind"], "board") << made;
  EXPECT_TRUE(capture["problem"].is_null()) << capture["problem"];
  EXPECT_EQ(capture["board"]["name"], "leather");
  EXPECT_FALSE(capture["board"]["pdf"].get<bool>());
  const Json again = running.page->Get("/api/boards").json()["boards"];
  ASSERT_EQ(again.size(), 1u) << again;
  EXPECT_EQ(again[0]["name"], "leather");
}

}  // namespace
}  // namespace glint
