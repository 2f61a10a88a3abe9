// Boards that were printed elsewhere: described, known, and put in another's place.
#include <gtest/gtest.h>

#include <thread>

#include "base/formats/capture.h"
#include "tests/studio/studio_fixture.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::Answer;
using test::ReadAll;
using test::RunningStudio;

constexpr char kToml[] =
    "[sample]\nsize_mm = [80, 80]  # of oak\nresolution_px = 64\n"
    "[photos]\nfiles = [\"photos/*.jpg\"]\nleft_out = [\"photos/b.jpg\"]\n"
    "[board]\nkind = \"charuco\"\nsquares = [12, 10]\nsquare_mm = 15\nmarker_mm = 11\n"
    "dictionary = \"DICT_4X4_250\"\nwindow = [3, 2, 6, 6]\n";

Answer Describe(const RunningStudio& running, const std::string& name, const std::string& text) {
  return running.page->Post("/api/boards", {{"file_name", name}, {"description", text}});
}

size_t KeptBoards(const RunningStudio& running) {
  size_t count = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(running.folder / ".glint-studio/boards", error)) {
    count += entry.is_directory() ? 1 : 0;
  }
  return count;
}

Answer SetBoard(const RunningStudio& running, const std::string& id, const Json& change) {
  return running.page->Send("PUT", "/api/captures/" + id + "/board", change);
}

Json DemoBoard(const RunningStudio& running) {
  const Json boards = running.page->Get("/api/boards").json()["boards"];
  for (const Json& board : boards) {
    if (board["name"] == "glint-demo") return board;
  }
  return nullptr;
}

TEST(Boards, OneIsDescribedByItsFileOrByAnotherCapturesTomlAndKeptOnce) {
  const RunningStudio running;
  const Json by_toml = Describe(running, "capture.toml", kToml).json();
  EXPECT_EQ(by_toml["name"], "charuco-12x10-15mm") << by_toml;
  EXPECT_EQ(by_toml["window_mm"], Json::array({90.0, 90.0}));
  const std::string text =
      ReadAll(running.folder / ".glint-studio/boards/charuco-12x10-15mm/board.json");
  EXPECT_EQ(Describe(running, "C:\\frames\\oak.json", text).json()["id"], by_toml["id"]);
  EXPECT_EQ(KeptBoards(running), 1u);
  Json other = Json::parse(text);
  other["square_mm"] = 16;
  other["about"] = "the large one";
  EXPECT_EQ(Describe(running, "../../oak frame.json", other.dump()).json()["name"], "oak_frame");
  EXPECT_EQ(ReadAll(running.folder / ".glint-studio/boards/oak_frame/board.json"), other.dump());
}

TEST(Boards, WhatDescribesNoneIsRefusedInTheFilesNameAndLeavesNothing) {
  const RunningStudio running;
  for (const char* text :
       {"", "{", "{}", "[board]\n", "[sample]\nsize_mm = 3\n", "[board]\nfile = \"board.json\"\n",
        "{\"glint_board\": 1, \"kind\": \"charuco\", \"squares\": [0, 9]}", "ÿØ"}) {
    const Answer answer = Describe(running, "mine.json", text);
    EXPECT_EQ(answer.status, 422) << text;
    const std::string message = answer.json()["error"]["message"];
    EXPECT_TRUE(message.starts_with("mine.json")) << message;
    EXPECT_EQ(message.find(running.folder.path().string()), std::string::npos) << message;
  }
  EXPECT_EQ(running.page->Post("/api/boards", {{"description", 3}}).status, 422);
  EXPECT_EQ(KeptBoards(running), 0u);
  for (const auto& entry : fs::directory_iterator(running.folder / ".glint-studio")) {
    EXPECT_FALSE(entry.path().filename().string().starts_with("new-")) << entry.path();
  }
}

TEST(Boards, TheDemosIsKnownWithoutAFile) {
  const RunningStudio running;
  const Json demo = DemoBoard(running);
  ASSERT_FALSE(demo.is_null());
  EXPECT_TRUE(demo["known"].get<bool>());
  const Json made = running.page
                        ->Post("/api/captures", {{"name", "leather"},
                                                 {"kind", "board"},
                                                 {"size_mm", {100, 100}},
                                                 {"board", demo["id"]}})
                        .json();
  const Json board = running.Capture(made.value("id", ""))["board"];
  EXPECT_EQ(board["name"], "glint-demo") << made;
  EXPECT_EQ(board["squares"], Json::array({18, 14}));
  EXPECT_FALSE(DemoBoard(running)["known"].get<bool>());  // kept now, and listed once
  EXPECT_EQ(running.page->Get("/api/boards").json()["boards"].size(), 1u);
}

TEST(Boards, ACapturesBoardBecomesAnotherAndTheOldOneStaysBesideIt) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  running.folder.Write("wood/board.pdf", "sheet");
  const fs::path folder = running.folder / "wood";
  const std::string old_board = ReadAll(folder / "board.json");
  std::string toml = ReadAll(folder / "capture.toml");
  toml.insert(toml.find("# measured_ruler_mm"), "measured_ruler_mm = 149\n");
  running.folder.Write("wood/capture.toml", toml);
  const Answer answer =
      SetBoard(running, id, {{"board", DemoBoard(running)["id"]}, {"size_mm", {90, 80}}});
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(answer.json()["board"]["name"], "glint-demo");
  EXPECT_EQ(answer.json()["size_mm"], Json::array({90.0, 80.0}));
  const Capture capture = ReadCapture(folder, Photographs::kMayBeMissing);
  EXPECT_EQ(capture.board.squares_x, 18);
  EXPECT_EQ(capture.board.print_scale, 1);  // the old sheet's ruler is not this one's
  EXPECT_EQ(ReadAll(folder / "board-1.json"), old_board);
  EXPECT_EQ(ReadAll(folder / "board-1.pdf"), "sheet");
  EXPECT_FALSE(fs::exists(folder / "board.pdf"));
  // And back: the same description is not kept twice.
  const Json printed = running.page->Get("/api/boards").json()["boards"][0];
  EXPECT_EQ(SetBoard(running, id, {{"board", printed["id"]}}).status, 200);
  EXPECT_EQ(SetBoard(running, id, {{"board", DemoBoard(running)["id"]}}).status, 200);
  EXPECT_TRUE(fs::exists(folder / "board-2.json"));
  EXPECT_FALSE(fs::exists(folder / "board-3.json"));
}

TEST(Boards, ABoardOfFiguresInCaptureTomlIsKeptAsAFile) {
  const RunningStudio running;
  running.folder.Write("oak/capture.toml", kToml);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // the list is a second old at most
  const std::string id = running.page->Get("/api/library").json()["captures"][0]["id"];
  const Answer answer = SetBoard(running, id, {{"board", DemoBoard(running)["id"]}});
  ASSERT_EQ(answer.status, 200) << answer.body;
  const Capture capture = ReadCapture(running.folder / "oak", Photographs::kMayBeMissing);
  EXPECT_EQ(capture.board_file, "board.json");
  EXPECT_EQ(capture.board.squares_x, 18);
  EXPECT_EQ(Json::parse(ReadAll(running.folder / "oak/board-1.json"))["squares"],
            Json::array({12, 10}));
  EXPECT_NE(ReadAll(running.folder / "oak/capture.toml").find("[80, 80]  # of oak"),
            std::string::npos);
}

TEST(Boards, AChangeThatIsRefusedLeavesTheCaptureAsItIs) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  const fs::path folder = running.folder / "wood";
  const std::string toml = ReadAll(folder / "capture.toml"), board = ReadAll(folder / "board.json");
  const Json demo = DemoBoard(running)["id"];
  EXPECT_EQ(SetBoard(running, id, {{"board", "0123"}}).status, 404);
  EXPECT_EQ(SetBoard(running, id, Json::object()).status, 404);
  EXPECT_EQ(SetBoard(running, id, {{"board", demo}, {"size_mm", {110, 80}}}).status, 422);
  EXPECT_EQ(SetBoard(running, id, {{"board", demo}, {"size_mm", {-3, 80}}}).status, 422);
  EXPECT_EQ(ReadCapture(folder, Photographs::kMayBeMissing).board.squares_x, 13);
  EXPECT_EQ(ReadCapture(folder, Photographs::kMayBeMissing).sample_size_mm[0], 100);
  // Metres for millimetres: whole boards hold any sample, but a capture of it would be refused.
  const std::string dot =
      R"({"glint_board": 1, "kind": "checkerboard", "squares": [5, 4], "square_mm": 0.1})";
  const Json small = Describe(running, "dot.json", dot).json()["id"];
  EXPECT_EQ(SetBoard(running, id, {{"board", small}}).status, 422);
  EXPECT_EQ(ReadAll(folder / "capture.toml"), toml);
  EXPECT_EQ(ReadAll(folder / "board.json"), board);
  // What a line's change cannot touch.
  const std::string inline_table =
      "board = { file = \"board.json\" }\n[sample]\nsize_mm = [100, 100]\n"
      "resolution_px = 64\n[photos]\nfiles = [\"photos/*.jpg\"]\n";
  running.folder.Write("wood/capture.toml", inline_table);
  EXPECT_EQ(SetBoard(running, id, {{"board", demo}}).status, 422);
  EXPECT_EQ(ReadAll(folder / "capture.toml"), inline_table);
  EXPECT_EQ(ReadAll(folder / "board.json"), board);
}

}  // namespace
}  // namespace glint
