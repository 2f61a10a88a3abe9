#include "base/programs/progress.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "tests/support/process.h"

namespace glint {
namespace {

// Lines that a bar of ten steps leaves in GLINT_PROGRESS_FILE.
std::vector<Json> LinesOfABar(const std::filesystem::path& file) {
  ::setenv(kProgressFileVariable, file.c_str(), 1);
  {
    Progress progress("corners", 10);
    progress.Advance(4, "photo \"4\"");
  }
  ::unsetenv(kProgressFileVariable);
  std::istringstream stream(test::ReadAll(file));
  std::vector<Json> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(Json::parse(line));
  return lines;
}

TEST(ProgressTest, OtherProgramsReadTheBarAsLinesOfJson) {
  const test::TemporaryFolder folder;
  const std::vector<Json> lines = LinesOfABar(folder.Write("progress", ""));
  ASSERT_GE(lines.size(), 2u);
  EXPECT_EQ(lines.front()["label"], "corners");
  EXPECT_EQ(lines.front()["share"], 0.0);
  EXPECT_TRUE(lines.front()["remaining_s"].is_null());
  EXPECT_EQ(lines.back()["share"], 0.4);
  EXPECT_TRUE(lines.back()["remaining_s"].is_number());
}

TEST(ProgressTest, OfAWholeRunTheShareIsTold) {
  const test::TemporaryFolder folder;
  // Stages before this one take 30 s, this one 10 s, those after it 60 s.
  ::setenv(kRunProgressVariable, ToText(RunProgress{SecondsSince1970() - 1, 30, 10, 60}).c_str(),
           1);
  const std::vector<Json> lines = LinesOfABar(folder.Write("progress", ""));
  ::unsetenv(kRunProgressVariable);
  ASSERT_FALSE(lines.empty());
  EXPECT_DOUBLE_EQ(lines.front()["share"].get<double>(), 0.3);
  EXPECT_NEAR(lines.front()["remaining_s"].get<double>(), 7.0 / 3, 0.5);
}

TEST(ProgressTest, AFileThatIsNotThereIsNotMade) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(LinesOfABar(folder / "absent").empty());
  EXPECT_FALSE(std::filesystem::exists(folder / "absent"));
}

}  // namespace
}  // namespace glint
