// Photographs that show another board than their capture's.
#include <gtest/gtest.h>

#include "datasets/synth/frame_board.h"
#include "pipeline/studio/photographs/boards_shown.h"
#include "tests/studio/studio_fixture.h"
#include "tests/studio/synthetic.h"

namespace glint {
namespace {

using test::RunningStudio;

TEST(BoardsShown, TheOneInThePhotographComesFirst) {
  const test::TemporaryFolder folder;
  test::MakeSynthetic(folder / "shot", 3);
  const Board shown = FrameBoard(100);
  Board whole = shown, other = shown, small = shown;
  whole.window.reset();
  other.squares_x = 15;
  small.dictionary = "DICT_4X4_250";
  Board chess = other;
  chess.kind = BoardKind::kCheckerboard;
  chess.window.reset();
  const auto found =
      BoardsShown(folder / "shot/photos/photo_000.jpg", {chess, other, whole, small, shown});
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0], 4u);
  for (const size_t index : found) EXPECT_TRUE(index == 4 || index == 2) << index;
}

TEST(OfferedBoards, PhotographsOfAnotherBoardAreTakenBackInWhenTheirsIsChosen) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  test::MakeSynthetic(running.folder / ".shots", 3);
  test::Headers photographs;
  for (const auto& file : std::filesystem::directory_iterator(running.folder / ".shots/photos")) {
    photographs.emplace_back(file.path().filename(), test::ReadAll(file.path()));
  }
  const std::string path = "/api/captures/" + id;
  EXPECT_TRUE(running.page->Get(path + "/boards").json()["boards"].empty());
  photographs.emplace_back("noise.jpg", test::JpegBytes(1));
  running.page->Upload(path + "/photographs", photographs);
  const Json before = running.CheckedCapture(id);
  for (const Json& photo : before["photographs"]) EXPECT_TRUE(photo["left_out"].get<bool>());
  EXPECT_EQ(before["status"], "empty");  // there is nothing to run
  const Json offer = running.page->Get(path + "/boards").json();
  EXPECT_TRUE(offer["another"].get<bool>());
  ASSERT_EQ(offer["boards"].size(), 1u) << offer;
  EXPECT_EQ(offer["boards"][0]["name"], "glint-demo");
  ASSERT_EQ(
      running.page->Send("PUT", path + "/board", {{"board", offer["boards"][0]["id"]}}).status,
      200);
  const Json after = running.CheckedCapture(id)["photographs"];
  for (const Json& photo : after) {
    const bool noise = photo["name"] == "noise.jpg";
    EXPECT_EQ(photo["left_out"].get<bool>(), noise) << photo;
    EXPECT_EQ(photo["board_found"].get<bool>(), !noise) << photo;
  }
  EXPECT_TRUE(running.page->Get(path + "/boards").json()["boards"].empty());
}

}  // namespace
}  // namespace glint
