// `glint init`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/images/image.h"
#include "tests/pipeline/driver/run_fixture.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using testing::HasSubstr;
using testing::Not;

TEST_F(RunTest, InitDescribesOnePhotographFromAbove) {
  const fs::path folder = folder_.path() / "single";
  fs::create_directories(folder);
  WritePng(folder / "a.png", Image(4, 3, {"R", "G", "B"}));
  const Outcome vague = Glint({"init", folder.string(), "--single"});
  EXPECT_EQ(vague.code, 2);
  EXPECT_THAT(vague.err, testing::HasSubstr("--width-mm"));
  const Outcome outcome = Glint({"init", folder.string(), "--single", "--width-mm", "120"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string text = test::ReadAll(folder / "capture.toml");
  EXPECT_THAT(text, testing::HasSubstr("size_mm = [81, 81]"));
  EXPECT_THAT(text, testing::HasSubstr("poses = \"above\""));
  EXPECT_THAT(text, testing::HasSubstr("picture_width_mm = 120"));
  const fs::path several = folder_.path() / "several";
  fs::create_directories(several);
  for (const char* name : {"a.png", "b.png"}) {
    WritePng(several / name, Image(4, 3, {"R", "G", "B"}));
  }
  const Outcome two = Glint({"init", several.string(), "--single", "--width-mm", "120"});
  EXPECT_EQ(two.code, 2);
  EXPECT_THAT(two.err, testing::HasSubstr("found 2 photographs"));
}

TEST_F(RunTest, InitDescribesWhatIsInTheFolderAndKeepsAnExistingFile) {
  const fs::path folder = folder_.path() / "new";
  test::WriteAll(folder / "photos/1.JPG", "x");
  test::WriteAll(folder / "photos/2.png", "x");
  test::WriteAll(folder / "board/1.jpg", "x");
  const Outcome first =
      Glint({"init", folder.string(), "--square-mm", "20", "--sample-mm", "90,80"});
  EXPECT_EQ(first.code, 0) << first.err;
  const std::string text = test::ReadAll(folder / "capture.toml");
  EXPECT_THAT(text, HasSubstr("files = [\"photos/*.jpg\", \"photos/*.png\"]"));
  EXPECT_THAT(text, HasSubstr("photos = [\"board/*.jpg\"]"));
  EXPECT_THAT(text, HasSubstr("size_mm = [90, 80]"));
  EXPECT_THAT(text, HasSubstr("window = [3, 5, 7, 7]"));
  const Outcome plan = Glint({"run", folder.string(), "--dry-run"});
  EXPECT_EQ(plan.code, 0) << plan.err;
  const Outcome second = Glint({"init", folder.string()});
  EXPECT_EQ(second.code, 2);
  EXPECT_EQ(test::ReadAll(folder / "capture.toml"), text);
}

TEST_F(RunTest, InitLeavesTheFilmsOfLivePhotosOut) {
  const fs::path folder = folder_.path() / "live";
  for (const char* name : {"IMG_1.JPG", "IMG_1.MOV", "IMG_2.HEIC", "IMG_2.mov"}) {
    test::WriteAll(folder / "photos" / name, "x");
  }
  EXPECT_EQ(Glint({"init", folder.string()}).code, 0);
  const std::string text = test::ReadAll(folder / "capture.toml");
  EXPECT_THAT(text, HasSubstr("files = [\"photos/*.heic\", \"photos/*.jpg\"]"));
  EXPECT_THAT(text, HasSubstr("# left out: IMG_1.MOV and 1 more"));
  EXPECT_THAT(text, testing::Not(HasSubstr("\nvideo = ")));
  // A film of its own is meant.
  test::WriteAll(folder / "photos/walk.mp4", "x");
  fs::remove(folder / "capture.toml");
  EXPECT_EQ(Glint({"init", folder.string()}).code, 0);
  EXPECT_THAT(test::ReadAll(folder / "capture.toml"), HasSubstr("video = [\"photos/walk.mp4\"]"));
}

TEST_F(RunTest, InitWithoutABoardTakesCamerasFromColmap) {
  const fs::path folder = folder_.path() / "open";
  test::WriteAll(folder / "photos/1.jpg", "x");
  ASSERT_EQ(Glint({"init", folder.string(), "--board", "none"}).code, 0);
  const std::string text = test::ReadAll(folder / "capture.toml");
  EXPECT_THAT(text, HasSubstr("poses = \"colmap\""));
  EXPECT_THAT(text, HasSubstr("size_mm = [100, 100]"));
  EXPECT_THAT(text, HasSubstr("\n[poses]"));
  EXPECT_THAT(text, Not(HasSubstr("[board]")));
  const Outcome plan = Glint({"run", folder.string(), "--dry-run"});
  EXPECT_EQ(plan.code, 0) << plan.err;
  const fs::path small = folder_.path() / "small";
  ASSERT_EQ(
      Glint({"init", small.string(), "--create", "--board", "none", "--sample-mm", "60x40"}).code,
      0);
  EXPECT_THAT(test::ReadAll(small / "capture.toml"), HasSubstr("size_mm = [60, 40]"));
}

TEST_F(RunTest, InitFindsPhotographsBeneathTheFolder) {
  const fs::path folder = folder_.path() / "wood & co";
  test::WriteAll(folder / "DCIM 1/1.JPG", "x");
  test::WriteAll(folder / "DCIM 1/2.jpg", "x");
  test::WriteAll(folder / "board/1.jpg", "x");
  test::WriteAll(folder / "board/2.jpg", "x");
  test::WriteAll(folder / "board/3.jpg", "x");
  test::WriteAll(folder / "screenshot.png", "x");
  ASSERT_EQ(Glint({"init", folder.string()}).code, 0);
  const std::string text = test::ReadAll(folder / "capture.toml");
  EXPECT_THAT(text, HasSubstr("files = [\"DCIM 1/*.jpg\"]"));
  EXPECT_THAT(text, HasSubstr("name = \"wood___co\""));
  const fs::path flat = folder_.path() / "flat";
  test::WriteAll(flat / "1.jpg", "x");
  ASSERT_EQ(Glint({"init", flat.string()}).code, 0);
  EXPECT_THAT(test::ReadAll(flat / "capture.toml"), HasSubstr("files = [\"*.jpg\"]"));
}

TEST_F(RunTest, InitDoesNotMakeAMistypedFolder) {
  const fs::path folder = folder_.path() / "wod";
  const Outcome outcome = Glint({"init", folder.string()});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no such folder; check its name, or make it with --create"));
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(RunTest, InitRefusesASampleLargerThanTheWindow) {
  const fs::path folder = folder_.path() / "new";
  fs::create_directories(folder);
  const Outcome outcome = Glint({"init", folder.string(), "--sample-mm", "100x140"});
  EXPECT_EQ(outcome.code, 2);  // seven squares of 15 mm are left out
  EXPECT_THAT(outcome.err, HasSubstr("--sample-mm: found [100, 140], which the board's window of "
                                     "[105, 105] is too small to show whole"));
  EXPECT_FALSE(fs::exists(folder / "capture.toml"));
  const Outcome wrong = Glint({"init", folder.string(), "--sample-mm", "100xabc"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("'100xabc' is not a number"));
}

TEST_F(RunTest, InitRefusesABoardThatCannotBe) {
  const fs::path folder = folder_.path() / "new";
  fs::create_directories(folder);
  const Outcome outcome = Glint({"init", folder.string(), "--marker-mm", "30"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("marker_mm"));
  EXPECT_FALSE(fs::exists(folder / "capture.toml"));
}

}  // namespace
}  // namespace glint
