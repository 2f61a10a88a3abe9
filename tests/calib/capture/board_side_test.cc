// A checkerboard that looks the same upside down, photographed from both sides of the table.
#include <OpenImageIO/imagebuf.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "base/formats/calibration.h"
#include "calib/capture/board_side.h"
#include "tests/calib/testing/synthetic_capture.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class BoardSide : public testing::SyntheticCapture {
 protected:
  static void SetUpTestSuite() {
    const test::TemporaryFolder folder;
    const fs::path board = folder.path() / "board.json";
    test::WriteAll(board, R"({"glint_board": 1, "kind": "checkerboard", "squares": [13, 17],)"
                          R"( "square_mm": 15.0})");
    Make({"--board", board.string(), "--megapixels", "2", "--photos", "5", "--resolution", "64",
          "--family", "leather", "--seed", "3"});
  }

  // As if the camera had been held the other way up, on the other side: the stored picture is the
  // same, and EXIF turns it.
  void FromTheOtherSide(int photo) const {
    const std::string file =
        (capture_ / ("photos/photo_00" + std::to_string(photo) + ".jpg")).string();
    OIIO::ImageBuf picture(file);
    picture.specmod().attribute("Orientation", 3);
    picture.specmod().attribute("Compression", "jpeg:97");
    ASSERT_TRUE(picture.read(0, 0, true));
    ASSERT_TRUE(picture.write(file)) << picture.geterror();
  }

  // Where the camera stands in the sample's frame.
  Eigen::Vector3d Camera(const fs::path& capture, size_t photo) const {
    const Calibration found = ReadCalibration(capture / "glint/calib/manifest.json");
    return Inverse(found.photos[photo].camera_from_sample).translation;
  }
};

TEST_F(BoardSide, TheSamplesTextureTellsIt) {
  const test::Outcome as_it_is =
      test::RunProgram({testing::Program("glint-calib"), capture_.string()});
  ASSERT_EQ(as_it_is.code, 0) << as_it_is.err;
  EXPECT_THAT(as_it_is.err, Not(HasSubstr("upside down")));
  std::vector<Eigen::Vector3d> cameras;
  for (size_t i = 0; i < 5; ++i) cameras.push_back(Camera(capture_, i));
  FromTheOtherSide(1);
  FromTheOtherSide(3);
  const test::Outcome turned =
      test::RunProgram({testing::Program("glint-calib"), capture_.string()});
  ASSERT_EQ(turned.code, 0) << turned.err;
  EXPECT_THAT(turned.err, HasSubstr("photos/photo_001.jpg, photos/photo_003.jpg: taken from the "
                                    "other side of the checkerboard"));
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_LT((Camera(capture_, i) - cameras[i]).norm(), 1) << i;
  }
}

// The board turned about its own centre takes a sample that lies beside it to another place.
TEST_F(BoardSide, TheTextureOfASampleOffTheBoardsCentreTellsItToo) {
  std::string toml = test::ReadAll(capture_ / "capture.toml");
  const std::string size = "size_mm = [100, 100]";
  ASSERT_NE(toml.find(size), std::string::npos);
  toml.replace(toml.find(size), size.size(), "size_mm = [45, 45]\ncentre_mm = [25, 25]");
  test::WriteAll(capture_ / "capture.toml", toml);
  FromTheOtherSide(1);
  FromTheOtherSide(3);
  const test::Outcome turned =
      test::RunProgram({testing::Program("glint-calib"), capture_.string()});
  ASSERT_EQ(turned.code, 0) << turned.err;
  EXPECT_THAT(turned.err, HasSubstr("photos/photo_001.jpg, photos/photo_003.jpg: taken from the "
                                    "other side of the checkerboard"));
  EXPECT_THAT(turned.err, Not(HasSubstr("does not show")));
}

TEST(LooksTheSameUpsideDown, WhereColumnsAndRowsAreBothOddOrBothEven) {
  Board board;
  board.kind = BoardKind::kCheckerboard;
  for (const auto& [x, y, same] : {std::tuple{13, 17, true}, {12, 16, true}, {10, 7, false}}) {
    board.squares_x = x;
    board.squares_y = y;
    EXPECT_EQ(LooksTheSameUpsideDown(board), same) << x << " x " << y;
  }
  board.kind = BoardKind::kCharuco;
  board.squares_x = board.squares_y = 13;
  EXPECT_FALSE(LooksTheSameUpsideDown(board));
}

TEST(SettleBoardSides, SaysThatAPlainSampleDoesNotTell) {
  Capture capture;
  capture.board.kind = BoardKind::kCheckerboard;
  capture.board.squares_x = capture.board.squares_y = 5;
  capture.board.square_mm = 10;
  capture.sample_size_mm = {20, 20};
  std::vector<DetectedPhoto> photos(3);
  for (size_t i = 0; i < photos.size(); ++i) {
    photos[i].name = "p" + std::to_string(i);
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) {
        const Eigen::Vector2d at = GridPointInSample(capture.board, column + 1, row + 1);
        CornerObservation corner;
        corner.id = 4 * row + column;
        corner.position_in_sample_mm = at;
        corner.point_px = {50 + at.x(), 50 - at.y()};
        photos[i].detection.corners.push_back(corner);
      }
    }
    photos[i].picture = {100, 100, 0, 0, 1, std::vector<std::uint16_t>(100 * 100, 30000)};
    std::mt19937 noise(static_cast<unsigned>(i));
    for (std::uint16_t& value : photos[i].picture.values) {
      value = static_cast<std::uint16_t>(value + noise() % 256);
    }
  }
  const std::vector<DetectedPhoto> before = photos;
  const std::vector<std::string> words = SettleBoardSides(capture, &photos);
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], HasSubstr("does not show which way round it lies in p0, p1, p2"));
  for (size_t i = 0; i < photos.size(); ++i) {
    EXPECT_EQ(photos[i].detection.corners[0].id, before[i].detection.corners[0].id);
  }
}

}  // namespace
}  // namespace glint
