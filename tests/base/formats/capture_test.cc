#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "base/errors/errors.h"
#include "base/formats/board_table.h"
#include "base/formats/capture.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr char kGood[] = R"([sample]
size_mm = [100, 50]
centre_mm = [1, 2]
resolution_px = 512
[photos]
files = ["photos/*.jpg"]
[board]
kind = "charuco"
squares = [12, 10]
square_mm = 15
marker_mm = 11
window = [3, 3, 6, 4]
[light]
offset_mm = [10, 0, 0]
power = 5
[refine]
iterations = 3
)";

class CaptureTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.Write("photos/b.JPG", "x");
    folder_.Write("photos/a.jpg", "x");
  }
  Capture Read(const std::string& text) {
    folder_.Write("capture.toml", text);
    return ReadCapture(folder_.path());
  }
  std::string Complaint(const std::string& text) {
    return test::MessageOf<UserError>([&] { Read(text); });
  }
  std::string Replaced(const std::string& what, const std::string& with) {
    std::string text = kGood;
    return text.replace(text.find(what), what.size(), with);
  }
  test::TemporaryFolder folder_;
};

// What Notepad and word processors make of a file.
TEST_F(CaptureTest, TextThatIsNoUtf8OrHasTypographicQuotesIsNamed) {
  EXPECT_THAT(Complaint("\xFF\xFE[\0s\0"), HasSubstr("in UTF-16: save it as UTF-8"));
  EXPECT_THAT(Complaint("[board]\nkind = \u201Ccharuco\u201D\n"), HasSubstr("typographic quotes"));
  EXPECT_THAT(Complaint("[board]\nsquare_mm = 13,5\n"), HasSubstr("with decimal points"));
}

TEST_F(CaptureTest, ReadsEveryTable) {
  const Capture capture = Read(kGood);
  EXPECT_THAT(capture.photos, ElementsAre("photos/a.jpg", "photos/b.JPG"));
  EXPECT_THAT(capture.resolution_px, ElementsAre(512, 256));
  EXPECT_TRUE(capture.has_board);
  EXPECT_EQ(capture.board.squares_x, 12);
  EXPECT_EQ(capture.board.window->rows, 4);
  EXPECT_EQ(capture.board.board_centre_in_sample_mm, Eigen::Vector2d(-1, -2));
  EXPECT_THAT(capture.light_power, ElementsAre(5, 5, 5));
}

TEST_F(CaptureTest, MissingFileSaysHowToWriteOne) {
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadCapture(folder_.path()); }),
              AllOf(HasSubstr("capture.toml"), HasSubstr("glint init")));
}

TEST_F(CaptureTest, SyntaxErrorNamesLine) {
  EXPECT_THAT(Complaint("[sample]\nsize_mm = [100,\n[photos]"), HasSubstr("line 3"));
}

TEST_F(CaptureTest, LengthsInCentimetresOrMetresAreToldByWhatTheyWouldMean) {
  std::string metres = Replaced("square_mm = 15", "square_mm = 0.015");
  metres.replace(metres.find("marker_mm = 11"), 14, "marker_mm = 0.011");
  EXPECT_THAT(Complaint(metres),
              AllOf(HasSubstr("board.square_mm: found 0.015, which makes a board of"),
                    HasSubstr("0.015 metres are 15")));
}

TEST_F(CaptureTest, UnknownKeysAreNamedWithTheKnownOnes) {
  EXPECT_THAT(Complaint(Replaced("square_mm", "square_cm")),
              AllOf(HasSubstr("board.square_cm"), HasSubstr("line 10")));
  EXPECT_THAT(Complaint(Replaced("[light]", "[lights]")), HasSubstr("lights"));
}

TEST_F(CaptureTest, WrongTypesAndUnitsAreNamed) {
  EXPECT_THAT(Complaint(Replaced("[100, 50]", "\"10 cm\"")),
              AllOf(HasSubstr("sample.size_mm"), HasSubstr("'10 cm'"), HasSubstr("millimetres")));
  EXPECT_THAT(Complaint(Replaced("[100, 50]", "[-100, 50]")), HasSubstr("positive"));
  EXPECT_THAT(Complaint(Replaced("squares = [12, 10]", "squares = [12.5, 10]")),
              HasSubstr("board.squares"));
  EXPECT_THAT(Complaint(Replaced("\"charuco\"", "\"circles\"")), HasSubstr("'circles'"));
}

TEST_F(CaptureTest, NoPhotographsIsAnError) {
  EXPECT_THAT(Complaint(Replaced("photos/*.jpg", "photos/*.png")),
              AllOf(HasSubstr("photos.files"), HasSubstr("no photograph")));
}

// A pattern's matches that cannot be read are named rather than passed over.
TEST_F(CaptureTest, PhotographsThatAreLeftOutAreNotUsed) {
  const std::string files = "files = [\"photos/*.jpg\"]\n";
  const Capture capture =
      Read(Replaced(files, files + "left_out = [\"photos/a.jpg\", \"photos/gone.jpg\"]\n"));
  EXPECT_THAT(capture.photos, ElementsAre("photos/b.JPG"));
  EXPECT_THAT(capture.left_out_photos, ElementsAre("photos/a.jpg"));
}

TEST_F(CaptureTest, ThereMayBeNoPhotographsYet) {
  folder_.Write("capture.toml", Replaced("*.jpg", "*.tif"));
  EXPECT_TRUE(ReadCapture(folder_.path(), Photographs::kMayBeMissing).photos.empty());
  EXPECT_THROW(ReadCapture(folder_.path()), UserError);
}

TEST_F(CaptureTest, WhatMatchesAndIsNoFileIsLeftOutWithAWarning) {
  std::filesystem::create_symlink("nowhere", folder_.path() / "photos/c.jpg");
  std::filesystem::create_directory(folder_.path() / "photos/d.jpg");
  ASSERT_EQ(::mkfifo((folder_.path() / "photos/e.jpg").c_str(), 0600), 0);
  testing::internal::CaptureStdout();  // where the library's log goes outside of programs
  const Capture capture = Read(kGood);
  const std::string log = testing::internal::GetCapturedStdout();
  EXPECT_THAT(capture.photos, ElementsAre("photos/a.jpg", "photos/b.JPG"));
  EXPECT_THAT(log, HasSubstr("c.jpg: left out: it matches 'photos/*.jpg', but is a "
                             "broken link"));
  EXPECT_THAT(log, HasSubstr("d.jpg: left out: it matches 'photos/*.jpg', but is a folder"));
  EXPECT_THAT(log, HasSubstr("e.jpg: left out"));
}

TEST_F(CaptureTest, PatternsCannotLeaveTheFolder) {
  EXPECT_THAT(Complaint(Replaced("photos/*.jpg", "../*.jpg")), HasSubstr("inside"));
}

TEST_F(CaptureTest, BoardThatCannotBePrintedIsRefused) {
  EXPECT_THAT(Complaint(Replaced("marker_mm = 11", "marker_mm = 16")), HasSubstr("marker_mm"));
}

TEST_F(CaptureTest, ReadsWhereTheSampleLiesInACOLMAPModel) {
  const std::string poses =
      "[poses]\nphoto = \"photos/a.jpg\"\ncorners_px = [[1, 2], [3, 2.5], [3, 4], [1, 4]]\n";
  const Capture capture = Read(Replaced("[light]", poses + "[light]"));
  EXPECT_EQ(capture.poses.photo, "photos/a.jpg");
  EXPECT_THAT(capture.poses.corners_px, ElementsAre(1, 2, 3, 2.5, 3, 4, 1, 4));
  EXPECT_FALSE(capture.imported());
}

TEST_F(CaptureTest, HalfALengthOrTwoAreRefused) {
  const auto complaint = [&](const std::string& poses) {
    return Complaint(Replaced("[light]", "[poses]\n" + poses + "\n[light]"));
  };
  EXPECT_THAT(complaint("points_mm = 3"), HasSubstr("poses.points_px: found no such key"));
  EXPECT_THAT(complaint("origin_px = [1, 2]"), HasSubstr("poses.photo"));
  EXPECT_THAT(complaint("photo = \"photos/c.jpg\""), HasSubstr("'photos/c.jpg'"));
  EXPECT_THAT(complaint("cameras = [\"photos/a.jpg\"]\ncameras_mm = 4"), HasSubstr("1 names"));
  EXPECT_THAT(complaint("height_mm = -1"), HasSubstr("poses.height_mm"));
  EXPECT_THAT(complaint("corners_px = [[1, 2], [3, 4]]"), HasSubstr("four points"));
  EXPECT_THAT(complaint("photo = \"photos/a.jpg\"\nheight_mm = 300\npoints_mm = 3\npoints_px = "
                        "[[1, 2], [3, 4]]"),
              HasSubstr("2 lengths"));
}

TEST_F(CaptureTest, ReadsAChart) {
  folder_.Write("chart/c.jpg", "x");
  folder_.Write("patches.csv", "x");
  const auto chart = [&](const std::string& keys) {
    return Read(Replaced("[light]", "[chart]\nphoto = \"chart/c.jpg\"\n" + keys + "\n[light]"))
        .chart;
  };
  EXPECT_FALSE(Read(kGood).chart.present());
  EXPECT_EQ(chart("").kind, "classic24");
  EXPECT_EQ(chart("kind = \"sg140\"\nmodel = \"root-polynomial\"").model, "root-polynomial");
  const std::string corners = "corners_px = [[1, 2], [9, 2], [9, 8], [1, 8]]\n";
  EXPECT_TRUE(chart(corners + "kind = \"patches.csv\"\nilluminant = \"A\"").kind_is_file());
  EXPECT_EQ(chart(corners + "kind = \"grey\"\nreflectance = 0.5").reflectance, 0.5);
  EXPECT_THAT(chart(corners).corners_px, ElementsAre(1, 2, 9, 2, 9, 8, 1, 8));
}

TEST_F(CaptureTest, SaysWhatIsWrongWithAChart) {
  folder_.Write("chart/c.jpg", "x");
  const auto complaint = [&](const std::string& keys) {
    return Complaint(Replaced("[light]", "[chart]\n" + keys + "\n[light]"));
  };
  const std::string photo = "photo = \"chart/c.jpg\"\n";
  EXPECT_THAT(complaint(""), HasSubstr("chart.photo: found no such key"));
  EXPECT_THAT(complaint("photo = \"chart/d.jpg\""), HasSubstr("no file 'chart/d.jpg'"));
  EXPECT_THAT(complaint(photo + "kind = \"classic\""), HasSubstr("classic24, sg140, vinyl18"));
  EXPECT_THAT(complaint(photo + "kind = \"p.csv\""), HasSubstr("no file 'p.csv'"));
  EXPECT_THAT(complaint(photo + "kind = \"grey\""),
              AllOf(HasSubstr("chart.corners_px"),
                    HasSubstr("only the kinds classic24, sg140 and vinyl18 are found")));
  EXPECT_THAT(complaint(photo + "illuminant = \"D65\""), HasSubstr("PATCHES.csv"));
  EXPECT_THAT(complaint(photo + "reflectance = 0.18"), HasSubstr("grey"));
  EXPECT_THAT(complaint(photo + "corners_px = [1, 2]"), HasSubstr("four points"));
  EXPECT_THAT(complaint(photo + "colour = 1"), HasSubstr("unknown key"));
}

TEST_F(CaptureTest, ItsBoardCanBeReadWithoutTheRest) {
  const auto file = folder_.Write(
      "elsewhere.toml",
      "[sample]\nsize = 3\n" + std::string(kGood).substr(std::string(kGood).find("[photos]")));
  const Board board = ReadDescribedBoard(file);
  EXPECT_EQ(board.squares_x, 12);
  EXPECT_EQ(board.window->rows, 4);
  const auto complaint = [&](const std::string& text) {
    folder_.Write("elsewhere.toml", text);
    return test::MessageOf<UserError>([&] { ReadDescribedBoard(file); });
  };
  EXPECT_THAT(complaint("[sample]\n"), HasSubstr("board: found no such table"));
  EXPECT_THAT(complaint("[board]\nfile = \"board.json\"\n"), HasSubstr("give that file itself"));
  EXPECT_THAT(complaint("[board]\nsquares = [12, 10]\n"), HasSubstr("board.square_mm"));
}

}  // namespace
}  // namespace glint
