#include "base/formats/board_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors/errors.h"
#include "base/formats/capture.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr char kMarkerFrame[] = R"({"glint_board": 1, "kind": "markers", "dictionary": "tag36h11",
"markers": [
 {"id": 3, "centre_mm": [-40, 10], "side_mm": 20},
 {"id": 7, "centre_mm": [40, 10], "side_mm": 20, "turn_deg": 90},
 {"id": 9, "corners_mm": [[-10, -50], [10, -50], [10, -70], [-10, -70]]}],
"opening_mm": [-25, -25, 25, 25],
"ruler": {"from_mm": [-50, 0], "to_mm": [50, 0]},
"patches": [{"rectangle_mm": [60, 0, 70, 10], "reflectance": 0.18}]})";

constexpr char kCharuco[] = R"({"glint_board": 1, "kind": "charuco", "squares": [13, 17],
"square_mm": 15, "marker_mm": 11, "dictionary": "DICT_5X5_1000", "legacy_layout": true,
"window": [3, 5, 7, 7], "ruler": {"from_mm": [-75, -140], "to_mm": [75, -140]},
"sheet": {"size_mm": [210, 297], "board_centre_mm": [105, 156]}})";

class BoardFileTest : public ::testing::Test {
 protected:
  BoardFile Read(const std::string& text) {
    return ReadBoardFile(folder_.Write("board.json", text));
  }
  std::string Complaint(std::string text, const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
    return test::MessageOf<UserError>([&] { Read(text); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(BoardFileTest, ListsMarkersByCentreOrByCorners) {
  const Board board = Read(kMarkerFrame).board;
  ASSERT_EQ(board.markers.size(), 3u);
  EXPECT_EQ(board.dictionary, "DICT_APRILTAG_36h11");
  EXPECT_EQ(board.square_mm, 20);
  EXPECT_TRUE(board.markers[0].corners_in_board_mm[0].isApprox(Eigen::Vector2d(-50, 20)));
  EXPECT_TRUE(board.markers[0].corners_in_board_mm[2].isApprox(Eigen::Vector2d(-30, 0)));
  // A quarter turn counterclockwise: its own top left is at the bottom left.
  EXPECT_TRUE(board.markers[1].corners_in_board_mm[0].isApprox(Eigen::Vector2d(30, 0)));
  EXPECT_EQ(BoardCorners(board)[11].id, 4 * 9 + 3);
  EXPECT_EQ(OutlineInSample(board).bottom_mm, -70);
  EXPECT_EQ(OpeningInSample(board)->right_mm, 25);
  EXPECT_EQ(board.ruler->length_mm(), 100);
  EXPECT_EQ(board.patches[0].reflectance, 0.18);
}

TEST_F(BoardFileTest, WritesWhatItReads) {
  for (const char* text : {kMarkerFrame, kCharuco}) {
    BoardFile file = Read(text);
    ScaleBoard(0.97, &file.board);
    const std::string once = ToJson(file).dump(2);
    EXPECT_EQ(ToJson(Read(once)).dump(2), once);
  }
}

TEST_F(BoardFileTest, SaysWhatIsWrong) {
  EXPECT_THAT(Complaint(kCharuco, "\"glint_board\": 1", "\"glint_board\": 2"),
              AllOf(HasSubstr("board.json: glint_board: found 2"), HasSubstr("version 1")));
  EXPECT_THAT(Complaint(kCharuco, "charuco", "circles"), HasSubstr("found \"circles\""));
  EXPECT_THAT(Complaint(kCharuco, "\"square_mm\": 15", "\"square_mm\": \"15\""),
              HasSubstr("square_mm: found \"15\""));
  EXPECT_THAT(Complaint(kCharuco, "square_mm", "square_cm"), HasSubstr("square_mm"));
  EXPECT_THAT(Complaint(kCharuco, "legacy_layout", "legacy"),
              AllOf(HasSubstr("legacy: found an unknown field"), HasSubstr("legacy_layout")));
  EXPECT_THAT(Complaint(kCharuco, "[13, 17]", "[13, 170]"), HasSubstr("need 1105"));
  EXPECT_THAT(Complaint(kCharuco, "{\"glint", "\"glint"), HasSubstr("not JSON"));
  EXPECT_THAT(Complaint(kMarkerFrame, "\"id\": 7", "\"id\": 3"), HasSubstr("3 a second time"));
  EXPECT_THAT(Complaint(kMarkerFrame, "\"id\": 7", "\"id\": 587"), HasSubstr("0 to 586"));
  EXPECT_THAT(Complaint(kMarkerFrame, "tag36h11", "tag37h11"), HasSubstr("\"tag37h11\""));
  EXPECT_THAT(Complaint(kMarkerFrame, "[[-10, -50], [10, -50], [10, -70], [-10, -70]]",
                        "[[-10, -70], [10, -70], [10, -50], [-10, -50]]"),
              AllOf(HasSubstr("markers[2]"), HasSubstr("anticlockwise")));
  EXPECT_THAT(Complaint(kMarkerFrame, "[[-10, -50], [10, -50], [10, -70]",
                        "[[-10, -50], [10, -70], [10, -50]"),
              HasSubstr("do not form a square"));
  EXPECT_THAT(Complaint(kMarkerFrame, "[-25, -25, 25, 25]", "[-25, -25, 45, 25]"),
              AllOf(HasSubstr("opening_mm"), HasSubstr("marker 7")));
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadBoardFile(folder_ / "none.json"); }),
              HasSubstr("none.json"));
}

class CaptureWithBoardFile : public BoardFileTest {
 protected:
  Capture ReadWith(const std::string& table) {
    folder_.Write("photos/a.jpg", "x");
    folder_.Write("capture.toml",
                  "[sample]\nsize_mm = [40, 40]\ncentre_mm = [1, 2]\n"
                  "[photos]\nfiles = [\"photos/*.jpg\"]\n[board]\n" +
                      table);
    return ReadCapture(folder_.path());
  }
};

TEST_F(CaptureWithBoardFile, TakesTheBoardFromTheFile) {
  folder_.Write("board.json", kCharuco);
  const Capture capture = ReadWith("file = \"board.json\"\n");
  EXPECT_EQ(capture.board_file, "board.json");
  EXPECT_EQ(capture.board.squares_y, 17);
  EXPECT_TRUE(capture.board.legacy_layout);
  EXPECT_EQ(capture.board.board_centre_in_sample_mm, Eigen::Vector2d(-1, -2));
  EXPECT_EQ(capture.board.print_scale, 1);
}

TEST_F(CaptureWithBoardFile, AMeasuredRulerCorrectsEveryLength) {
  folder_.Write("board.json", kCharuco);
  const Board board = ReadWith("file = \"board.json\"\nmeasured_ruler_mm = 145.5\n").board;
  EXPECT_DOUBLE_EQ(board.print_scale, 0.97);
  EXPECT_DOUBLE_EQ(board.square_mm, 15 * 0.97);
  EXPECT_DOUBLE_EQ(board.marker_mm, 11 * 0.97);
  EXPECT_DOUBLE_EQ(board.ruler->length_mm(), 145.5);
  EXPECT_THAT(PrintScaleInWords(board), HasSubstr("97.00 %"));
  EXPECT_THAT(PrintScaleInWords(board), HasSubstr("ruler of 150 mm is 145.50 mm long"));
  EXPECT_THAT(test::MessageOf<UserError>(
                  [&] { ReadWith("file = \"board.json\"\nmeasured_ruler_mm = 14.55\n"); }),
              AllOf(HasSubstr("14.55 mm measured on a ruler of 150 mm"), HasSubstr("millimetres")));
}

TEST_F(CaptureWithBoardFile, SaysTwoDescriptionsAreOneTooMany) {
  folder_.Write("board.json", kCharuco);
  EXPECT_THAT(
      test::MessageOf<UserError>([&] { ReadWith("file = \"board.json\"\nsquare_mm = 15\n"); }),
      HasSubstr("board.square_mm"));
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadWith("file = \"other.json\"\n"); }),
              HasSubstr("no file 'other.json'"));
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadWith("kind = \"markers\"\n"); }),
              HasSubstr("file = \"board.json\""));
  EXPECT_THAT(test::MessageOf<UserError>([&] {
                ReadWith("squares = [5, 5]\nsquare_mm = 5\nmarker_mm = 4\nmeasured_ruler_mm = 9\n");
              }),
              HasSubstr("measured_ruler_mm"));
}

}  // namespace
}  // namespace glint
