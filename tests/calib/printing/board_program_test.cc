// glint-board as a person runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>

#include "base/files/files.h"
#include "base/formats/board_file.h"
#include "base/formats/capture.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

struct Result {
  int code = -1;
  std::string output;  // stdout and stderr
};

Result RunCommand(const std::string& command) {
  Result result;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer;
  while (const size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) {
    result.output.append(buffer.data(), n);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) result.code = WEXITSTATUS(status);
  return result;
}

Result RunGlint(const std::string& verb, const std::string& arguments) {
  return RunCommand(std::string(GLINT_BIN_DIR) + "/glint-" + verb + " " + arguments);
}

Result CheckSchema(const fs::path& file) {
  const std::string root = GLINT_SOURCE_DIR;
  return RunCommand("python3 " + root + "/tests/base/formats/check_manifests.py " + root +
                    "/base/formats/board.schema.json " + file.string());
}

TEST(BoardProgram, PrintsABoardThatInitAndCalibTake) {
  const test::TemporaryFolder folder;
  const fs::path a = folder / "a", b = folder / "b";
  const Result first = RunGlint("board", a.string() + " --sample-mm 90,60 --patches 0.85,0.18");
  ASSERT_EQ(first.code, 0) << first.output;
  EXPECT_THAT(first.output, AllOf(HasSubstr("file = \"board.json\""), HasSubstr("100 %"),
                                  HasSubstr("--measured")));
  ASSERT_EQ(RunGlint("board", b.string() + " --sample-mm 90,60 --patches 0.85,0.18").code, 0);
  for (const char* name : {"board.pdf", "board.svg", "board.json"}) {
    EXPECT_EQ(ReadTextFile(a / name), ReadTextFile(b / name)) << name;
  }
  const Result schema = CheckSchema(a / "board.json");
  EXPECT_EQ(schema.code, 0) << schema.output;
  ASSERT_EQ(RunGlint("init", a.string()).code, 0);
  folder.Write("a/photos/x.jpg", "x");
  const Capture capture = ReadCapture(a);
  EXPECT_EQ(capture.board_file, "board.json");
  EXPECT_EQ(ToJson({capture.board, {}})["patches"].size(), 2u);
  EXPECT_GE(capture.board.window->columns * capture.board.square_mm, 90);
}

TEST(BoardProgram, CorrectsWhatAPrinterScaled) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "board.json";
  ASSERT_EQ(RunGlint("board", folder.path().string()).code, 0);
  const Board designed = ReadBoardFile(file).board;
  // Twice: the second is no correction of the first.
  for (int i = 0; i < 2; ++i) {
    const Result result = RunGlint("board", folder.path().string() + " --measured 145.5");
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, AllOf(HasSubstr("97.00 %"), HasSubstr("14.55 mm")));
    const Board printed = ReadBoardFile(file).board;
    EXPECT_NEAR(printed.square_mm, 0.97 * designed.square_mm, 1e-12);
    EXPECT_NEAR(printed.marker_mm, 0.97 * designed.marker_mm, 1e-12);
    EXPECT_NEAR(printed.print_scale, 0.97, 1e-12);
  }
  EXPECT_EQ(CheckSchema(file).code, 0);
  const Result wrong = RunGlint("board", folder.path().string() + " --measured 14.55");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.output, HasSubstr("in millimetres"));
}

TEST(BoardProgram, PrintsTheFrameOfTheDocumentation) {
  const test::TemporaryFolder folder;
  const fs::path example = fs::path(GLINT_SOURCE_DIR) / "docs/boards/materialgan.json";
  const Result schema = CheckSchema(example);
  EXPECT_EQ(schema.code, 0) << schema.output;
  const Result result = RunGlint("board", folder.path().string() + " --from " + example.string());
  ASSERT_EQ(result.code, 0) << result.output;
  const BoardFile file = ReadBoardFile(folder / "board.json");
  EXPECT_EQ(file.board.markers.size(), 16u);
  EXPECT_EQ(file.board.square_mm, 20);
  ASSERT_TRUE(file.sheet);
}

TEST(BoardProgram, SaysWhatIsWrong) {
  const test::TemporaryFolder folder;
  const std::string where = folder.path().string();
  const Result paper = RunGlint("board", where + " --paper B4");
  EXPECT_EQ(paper.code, 2);
  EXPECT_THAT(paper.output, HasSubstr("--paper: found 'B4'"));
  EXPECT_FALSE(fs::exists(folder / "board.json"));
  EXPECT_EQ(RunGlint("board", where + " --measured 150").code, 2);
  ASSERT_EQ(RunGlint("board", where).code, 0);
  const Result again = RunGlint("board", where + " --paper A3");
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.output, AllOf(HasSubstr("an existing board.json"), HasSubstr("--force")));
  EXPECT_EQ(RunGlint("board", where + " --paper A3 --force").code, 0);
  EXPECT_EQ(ReadBoardFile(folder / "board.json").sheet->width_mm, 297);
}

}  // namespace
}  // namespace glint
